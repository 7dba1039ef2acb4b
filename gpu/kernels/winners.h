// From sums to winners, those of the left view and of the right one (engine/stereo/selection.h).
//
// A block does a row, a warp a pixel at a time, each lane 8 disparities. The sums are read once,
// for both views. Right pixels are offered what belongs to them by an atomic minimum in shared
// memory.
#pragma once

#include <cstdint>

#include "gpu/frame.h"
#include "gpu/kernels/paths.h"
#include "gpu/kernels/simt.h"

namespace vs::gpu {

inline constexpr int kWinnerCells = 8;
inline constexpr int kWinnerThreads = 256;
inline constexpr uint32_t kLargestSum = 255;

// Right pixels in an order in which the lanes of a warp, 8 pixels apart, meet different banks.
struct RightRow {
  static constexpr int kColumns = kMaxPictureWidth / kWinnerCells + 1;
  static constexpr int kSlots = kWinnerCells * kColumns;
  VS_DEVICE static int Slot(int x) { return x % kWinnerCells * kColumns + x / kWinnerCells; }
};

// min(255, sum of the volumes) of this lane's cells; 255 in those that mean nothing.
VS_DEVICE CellBytes<kWinnerCells> SumsOf(const Frame& frame, uint32_t pixel) {
  uint32_t even[2] = {};  // cells 0 and 2, 4 and 6, as pairs
  uint32_t odd[2] = {};
  for (int k = 0; k < Frame::kMaxSums; ++k) {
    if (k >= frame.sum_count) break;
    const auto cells = LoadCells<kWinnerCells>(frame.sums[k], pixel, frame.pitch);
    for (int w = 0; w < 2; ++w) {
      even[w] = AddPairs(even[w], cells.word[w] & 0x00ff00ff);
      odd[w] = AddPairs(odd[w], (cells.word[w] >> 8) & 0x00ff00ff);
    }
  }
  CellBytes<kWinnerCells> sums;
  for (int w = 0; w < 2; ++w) {
    sums.word[w] = MinPairs(even[w], Both(kLargestSum)) | MinPairs(odd[w], Both(kLargestSum)) << 8;
    const int meaning = frame.settings.num_disparities - (Lane() * kWinnerCells + 4 * w);
    if (meaning < 4) sums.word[w] |= meaning <= 0 ? 0xffffffffU : 0xffffffffU << (8 * meaning);
  }
  return sums;
}

VS_DEVICE uint32_t CellOf(const CellBytes<kWinnerCells>& cells, int k) {
  return (cells.word[k / 4] >> (8 * (k % 4))) & 0xff;
}

VS_KERNEL SelectRow(const Frame frame) {
  VS_SHARED uint32_t right[RightRow::kSlots];  // 256 * sum + index
  const int y = BlockX();
  for (int k = ThreadInBlock(); k < RightRow::kSlots; k += ThreadsInBlock()) {
    right[k] = kLargestSum << 8;
  }
  SyncBlock();
  const int first = Lane() * kWinnerCells;  // index of this lane's first cell
  for (int x = WarpInBlock(); x < frame.width; x += WarpsInBlock()) {
    const int pixel = y * frame.width + x;
    const auto sums = SumsOf(frame, static_cast<uint32_t>(pixel));
    uint32_t keys[kWinnerCells];
    uint32_t least = 0xffff;
    for (int k = 0; k < kWinnerCells; ++k) {
      keys[k] = CellOf(sums, k) << 8 | static_cast<uint32_t>(first + k);
      least = Lesser(least, keys[k]);
    }
    least = WarpMin(least);
    const int winner = static_cast<int>(least & 0xff);
    uint32_t second = kLargestSum;
    for (int k = 0; k < kWinnerCells; ++k) {
      if (Distance(first + k, winner) > 1) second = Lesser(second, keys[k] >> 8);
    }
    second = WarpMin(second);
    for (int k = 0; k < kWinnerCells; ++k) {
      const auto cell = static_cast<uint8_t>(keys[k] >> 8);
      if (first + k == winner - 1) frame.winner_before[pixel] = cell;
      if (first + k == winner + 1) frame.winner_after[pixel] = cell;
    }
    if (Lane() == 0) {
      frame.winner_index[pixel] = static_cast<uint8_t>(winner);
      frame.winner_best[pixel] = static_cast<uint8_t>(least >> 8);
      frame.winner_second[pixel] = static_cast<uint8_t>(second);
    }
    if (!frame.settings.left_right_check) continue;
    for (int k = 0; k < kWinnerCells; ++k) {
      const int counterpart = x - frame.settings.min_disparity - (first + k);
      if (counterpart < 0 || counterpart >= frame.width) continue;
      uint32_t* const slot = &right[RightRow::Slot(counterpart)];
      // Most offers come too late; looking is cheaper.
      if (keys[k] < ReadShared(slot)) AtomicMin(slot, keys[k]);
    }
  }
  SyncBlock();
  for (int x = ThreadInBlock(); x < frame.width; x += ThreadsInBlock()) {
    frame.right_index[y * frame.width + x] = static_cast<uint8_t>(right[RightRow::Slot(x)]);
  }
}

// sums -> winner_..., right_index.
template <class Launch>
void SelectWinners(Launch& launch, const Frame& frame) {
  launch(&SelectRow, Grid{frame.height}, kWinnerThreads, frame);
}

}  // namespace vs::gpu
