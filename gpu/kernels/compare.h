// Costs of pixels (engine/stereo/pixel_cost.h): every cell is written once.
#pragma once

#include <cstddef>
#include <cstdint>

#include "gpu/frame.h"
#include "gpu/kernels/features.h"
#include "gpu/kernels/paths.h"
#include "gpu/kernels/simt.h"

namespace vs::gpu {

// Cells that a thread does at a time.
inline constexpr int kCostCells = 8;
using CostBytes = CellBytes<kCostCells>;
inline constexpr int kCostThreads = 256;

// What a pixel is compared by.
struct Feature {
  uint32_t code;
  uint32_t code_high;
  uint32_t coarse;
};

enum class CostKind { kSad, kBirchfieldTomasi, kCensus, kAdCensus, kLongCensus, kLongAdCensus };

template <CostKind kKind>
VS_DEVICE Feature FeatureAt(const Frame& frame, int view, int pixel) {
  constexpr bool kLong = kKind == CostKind::kLongCensus || kKind == CostKind::kLongAdCensus;
  return {frame.code[view][pixel], kLong ? frame.code_high[view][pixel] : 0,
          kLong ? frame.coarse[view][pixel] : 0U};
}

VS_DEVICE int Excess(int a, int b) { return Greater(a - b, 0); }
VS_DEVICE int ByteOf(uint32_t word, int k) { return static_cast<int>((word >> (8 * k)) & 0xff); }

// C of engine/stereo/pixel_cost.h.
template <CostKind kKind>
VS_DEVICE int CostOf(const Feature& l, const Feature& r, const SgmSettings& settings) {
  if constexpr (kKind == CostKind::kSad) {
    return Lesser(Distance(ByteOf(l.code, 0), ByteOf(r.code, 0)), settings.grey_limit);
  } else if constexpr (kKind == CostKind::kBirchfieldTomasi) {
    const int a = Greater(Excess(ByteOf(l.code, 0), ByteOf(r.code, 2)),
                          Excess(ByteOf(r.code, 1), ByteOf(l.code, 0)));
    const int b = Greater(Excess(ByteOf(r.code, 0), ByteOf(l.code, 2)),
                          Excess(ByteOf(l.code, 1), ByteOf(r.code, 0)));
    return Lesser(Lesser(a, b), settings.grey_limit);
  } else if constexpr (kKind == CostKind::kCensus || kKind == CostKind::kAdCensus) {
    const int distance = CountBits((l.code ^ r.code) & 0x00ffffff);
    if constexpr (kKind == CostKind::kCensus) return distance;
    return distance + Lesser(Distance(ByteOf(l.code, 3), ByteOf(r.code, 3)), settings.ad_limit);
  } else {
    const int distance =
        (CountBits(l.code ^ r.code) + CountBits(l.code_high ^ r.code_high) + 1) >> 1;
    if constexpr (kKind == CostKind::kLongCensus) return distance;
    const int step = Distance(static_cast<int>(l.coarse), static_cast<int>(r.coarse));
    return distance + Lesser(step, settings.ad_limit);
  }
}

// Puts `outside` into the cells of pixel column x, from index `first` on, whose counterpart is not
// in the right picture, and 255 into those beyond the range.
VS_DEVICE void ResetCells(const Frame& frame, int x, int first, int outside, CostBytes* cells) {
  // Nearly everywhere there is nothing to do, and seeing that at once spares most instructions.
  const int last = first + kCostCells - 1;
  const int leftmost = x - frame.settings.min_disparity - last;
  if (leftmost >= 0 && leftmost + last - first < frame.width &&
      last < frame.settings.num_disparities) {
    return;
  }
  for (int k = 0; k < kCostCells; ++k) {
    const int i = first + k;
    const int counterpart = x - frame.settings.min_disparity - i;
    const bool beyond = i >= frame.settings.num_disparities;
    if (!beyond && counterpart >= 0 && counterpart < frame.width) continue;
    const auto value = static_cast<uint32_t>(beyond ? 255 : outside);
    uint32_t& word = cells->word[k / 4];
    word = (word & ~(0xffU << (8 * (k % 4)))) | value << (8 * (k % 4));
  }
}

VS_DEVICE CostBytes LoadCost(const Frame& frame, const uint8_t* volume, int x, int y, int first) {
  const size_t pixel = static_cast<size_t>(y) * frame.width + x;
  return *reinterpret_cast<const CostBytes*>(volume + pixel * frame.pitch + first);
}
VS_DEVICE void StoreCost(const CostBytes& cells, const Frame& frame, int x, int y, int first,
                         uint8_t* volume) {
  const size_t pixel = static_cast<size_t>(y) * frame.width + x;
  *reinterpret_cast<CostBytes*>(volume + pixel * frame.pitch + first) = cells;
}

// A thread goes along kCostSteps pixels with the same indices: from pixel to pixel it needs one
// more feature of the right view and gives up one. The threads of up to kCostStrips such strips
// make a block; the right pixels that they meet wait in shared memory.
inline constexpr int kCompareThreads = 128;
inline constexpr int kCostSteps = 16;
inline constexpr int kCostStrips = 8;

VS_HOST_DEVICE int StripsOfBlock(const Frame& frame) {
  return Lesser(kCompareThreads / (frame.pitch / kCostCells), kCostStrips);
}

template <CostKind kKind>
VS_KERNEL ComparePixels(const Frame frame, int outside, uint8_t* costs) {
  // With gaps, so that the lanes of a warp, 8 pixels apart, meet different banks.
  constexpr int kPixels = kCostSteps * kCostStrips + 256;
  VS_SHARED Feature right[kPixels + kPixels / kCostCells];
  const auto slot = [](int k) { return k + (k >> 3); };
  static_assert(kCostCells == 1 << 3);
  const int row = BlockY() * frame.width;
  const int strips = StripsOfBlock(frame);
  const int x0 = BlockX() * strips * kCostSteps;
  // Right pixel of slot k.
  const int first_right = x0 - frame.settings.min_disparity - (frame.pitch - 1);
  for (int k = ThreadInBlock(); k < strips * kCostSteps + frame.pitch - 1; k += ThreadsInBlock()) {
    const int x = Clamp(first_right + k, 0, frame.width - 1);
    right[slot(k)] = FeatureAt<kKind>(frame, kRight, row + x);
  }
  SyncBlock();
  const int groups = frame.pitch / kCostCells;
  const int strip = ThreadInBlock() / groups;
  if (strip >= strips) return;
  const int first = ThreadInBlock() % groups * kCostCells;
  const int begin = strip * kCostSteps;
  const int newest = begin + frame.pitch - 1 - first;  // what cell `first` of pixel `begin` meets
  Feature met[kCostCells];                             // by cells first, first + 1, ...
  for (int k = 0; k < kCostCells - 1; ++k) met[k] = right[slot(newest - 1 - k)];
  for (int step = 0; step < kCostSteps; ++step) {
    const int x = x0 + begin + step;
    if (x >= frame.width) break;
    for (int k = kCostCells - 1; k > 0; --k) met[k] = met[k - 1];
    met[0] = right[slot(newest + step)];
    const Feature left = FeatureAt<kKind>(frame, kLeft, row + x);
    CostBytes cells = {};
    for (int k = 0; k < kCostCells; ++k) {
      const auto cost = static_cast<uint32_t>(CostOf<kKind>(left, met[k], frame.settings));
      cells.word[k / 4] |= cost << (8 * (k % 4));
    }
    ResetCells(frame, x, first, outside, &cells);
    StoreCost(cells, frame, x, BlockY(), first, costs);
  }
}

template <class Launch>
void Compare(Launch& launch, const Frame& frame, int outside, uint8_t* costs) {
  const SgmSettings& settings = frame.settings;
  const int pixels = StripsOfBlock(frame) * kCostSteps;
  const Grid grid{(frame.width + pixels - 1) / pixels, frame.height};
  const auto compare = [&](auto kernel) {
    launch(kernel, grid, kCompareThreads, frame, outside, costs);
  };
  if (settings.cost == MatchCost::kSad) return compare(&ComparePixels<CostKind::kSad>);
  if (settings.cost == MatchCost::kBirchfieldTomasi) {
    return compare(&ComparePixels<CostKind::kBirchfieldTomasi>);
  }
  const bool ad = settings.cost == MatchCost::kAdCensus;
  if (IsLongCode(settings.census)) {
    return ad ? compare(&ComparePixels<CostKind::kLongAdCensus>)
              : compare(&ComparePixels<CostKind::kLongCensus>);
  }
  return ad ? compare(&ComparePixels<CostKind::kAdCensus>)
            : compare(&ComparePixels<CostKind::kCensus>);
}

}  // namespace vs::gpu
