// What engine/stereo/condition_pair.h does to a pair, decided on the device from the pictures, so
// that nothing goes to the host and back within a frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "gpu/frame.h"
#include "gpu/kernels/scan.h"
#include "gpu/kernels/simt.h"

namespace vs::gpu {

inline constexpr int kNoiseBlock = 8;
inline constexpr int kNoiseBin = 4;
inline constexpr int kQuantiles = 19;
inline constexpr int kCountThreads = 256;

// Size of the answer of the mask (1 -2 1, -2 4 -2, 1 -2 1) at a pixel.
VS_DEVICE int MaskResponse(const uint8_t* at, int width) {
  const auto across = [](const uint8_t* p) { return p[-1] - 2 * p[0] + p[1]; };
  const int response = across(at - width) - 2 * across(at) + across(at + width);
  return response < 0 ? -response : response;
}

// A warp for each of `blocks` blocks of 8 x 8 pixels that are looked at, `step` apart, for there
// are too few of them to keep a device busy with a thread each; block y is the view.
VS_KERNEL CountNoise(const Frame frame, int columns, int blocks, int step) {
  const int view = BlockY();
  const int which = BlockX() * WarpsInBlock() + WarpInBlock();
  if (which >= blocks) return;  // the whole warp
  const int k = which * step;
  const int x = 1 + k % columns * kNoiseBlock + Lane() % kNoiseBlock;
  const int y = 1 + k / columns * kNoiseBlock + Lane() / kNoiseBlock;
  uint32_t response = 0;
  uint32_t counts = 1;  // unless greys reach an end of the scale
  constexpr int kRowsOfWarp = kWarpSize / kNoiseBlock;
  for (int row = y; row < y + kNoiseBlock; row += kRowsOfWarp) {
    const uint8_t* const at = frame.input[view] + ptrdiff_t{row} * frame.width + x;
    response += static_cast<uint32_t>(MaskResponse(at, frame.width));
    if (*at < 6 || *at > 249) counts = 0;
  }
  response = WarpSum(response);
  counts = WarpMin(counts);
  if (Lane() != 0 || counts == 0) return;
  const int bin = Lesser(static_cast<int>(response) / kNoiseBin, GreyCounts::kNoiseBins - 1);
  AtomicAdd(&frame.counts->noise[view][bin], 1);
}

// Columns of both views that show the same part of the scene, if it lies amid the range.
struct CommonColumns {
  int begin[2];
  int end[2];
};

// Rows that a block counts before it tells the others: each time it adds to up to 256 counters
// that all blocks share.
inline constexpr int kCountedRows = 4;

VS_KERNEL CountGreys(const Frame frame, const CommonColumns columns) {
  VS_SHARED uint32_t counts[256];
  const int view = BlockY();
  for (int g = ThreadInBlock(); g < 256; g += ThreadsInBlock()) counts[g] = 0;
  SyncBlock();
  const int end = Lesser((BlockX() + 1) * kCountedRows, frame.height);
  for (int y = BlockX() * kCountedRows; y < end; ++y) {
    const uint8_t* const row = frame.input[view] + ptrdiff_t{y} * frame.width;
    for (int x = columns.begin[view] + ThreadInBlock(); x < columns.end[view];
         x += ThreadsInBlock()) {
      AtomicAdd(&counts[row[x]], 1);
    }
  }
  SyncBlock();
  for (int g = ThreadInBlock(); g < 256; g += ThreadsInBlock()) {
    if (counts[g] > 0) AtomicAdd(&frame.counts->greys[view][g], counts[g]);
  }
}

// NoiseSixteenths of condition_pair.h, from the counts; all threads of the block get it.
VS_DEVICE int NoiseOf(const uint32_t* counts, uint32_t* room) {
  VS_SHARED int noise;
  constexpr int kEach = GreyCounts::kNoiseBins / kCountThreads;
  const int first = ThreadInBlock() * kEach;
  uint32_t own = 0;
  for (int k = 0; k < kEach; ++k) own += counts[first + k];
  if (ThreadInBlock() == 0) noise = 0;
  const uint32_t up_to_here = JoinUpToHere(own, Plus(), room);
  const uint32_t blocks = room[ThreadsInBlock() - 1];
  // The one bin at which 5 % are reached.
  uint32_t below = up_to_here - own;
  for (int k = 0; k < kEach && blocks > 0; ++k) {
    const uint32_t with = below + counts[first + k];
    if (below * 20 < blocks && with * 20 >= blocks) {
      noise = (first + k) * kNoiseBin * 16 * 100 / (kNoiseBlock * kNoiseBlock * 479 * 77 / 100);
    }
    below = with;
  }
  SyncBlock();
  const int result = noise;
  SyncBlock();
  return result;
}

// The quantiles 5 %, 10 % .. 95 % of the greys counted, in sixteenths of a grey level. A thread for
// each grey.
VS_DEVICE void FindQuantiles(const uint32_t* counts, int64_t pixels, uint32_t* room,
                             int* quantiles) {
  const int grey = ThreadInBlock();
  const int64_t count = counts[grey];
  const auto with = static_cast<int64_t>(JoinUpToHere(counts[grey], Plus(), room));
  const int64_t below = with - count;
  for (int k = 0; k < kQuantiles; ++k) {
    const int64_t wanted = pixels * (k + 1) / (kQuantiles + 1);
    if (below < wanted && with >= wanted) {
      quantiles[k] = 16 * grey - 8 + static_cast<int>(16 * (wanted - below) / count);
    }
  }
  SyncBlock();
}

// grey' = (gain * grey + offset) / 4096, as GreyMap.
struct GreyLine {
  int gain;
  int offset;
};

// MatchGreys of condition_pair.h, from the quantiles.
VS_HOST_DEVICE GreyLine LineThrough(const int* l, const int* r) {
  constexpr int kOne = 4096;
  constexpr GreyLine kIdentity{kOne, 0};
  int64_t sum_l = 0;
  int64_t sum_r = 0;
  int64_t sum_rr = 0;
  int64_t sum_lr = 0;
  int64_t difference = 0;
  for (int k = 0; k < kQuantiles; ++k) {
    sum_l += l[k];
    sum_r += r[k];
    sum_rr += int64_t{r[k]} * r[k];
    sum_lr += int64_t{l[k]} * r[k];
    difference += Distance(l[k], r[k]);
  }
  if (difference < int64_t{kQuantiles} * 5 * 16) return kIdentity;
  const int64_t spread = kQuantiles * sum_rr - sum_r * sum_r;
  if (spread < int64_t{kQuantiles} * kQuantiles * 64 * 64) return kIdentity;
  const int64_t gain = kOne * (kQuantiles * sum_lr - sum_l * sum_r) / spread;
  if (gain < kOne / 2 || gain > int64_t{kOne} * 2) return kIdentity;
  const int64_t offset = (kOne * sum_l - gain * sum_r) / (int64_t{kQuantiles} * 16);
  return {static_cast<int>(gain), static_cast<int>(offset)};
}

// One block of kCountThreads: what is done to the greys.
VS_KERNEL Decide(const Frame frame, const CommonColumns columns) {
  VS_SHARED uint32_t room[kCountThreads];
  VS_SHARED int quantiles[2][kQuantiles];
  VS_SHARED GreyLine line;
  const SgmSettings& settings = frame.settings;
  PreBlur blur = settings.pre_blur;
  if (blur == PreBlur::kAutomatic) {
    constexpr int kStrongBlurFrom = 29;  // sixteenths of a grey level
    const int left = NoiseOf(frame.counts->noise[kLeft], room);
    const int right = NoiseOf(frame.counts->noise[kRight], room);
    blur = Greater(left, right) >= kStrongBlurFrom ? PreBlur::kStrong : PreBlur::kOff;
  }
  if (settings.match_gain) {
    for (int view = 0; view < 2; ++view) {
      const int64_t pixels = int64_t{columns.end[view] - columns.begin[view]} * frame.height;
      FindQuantiles(frame.counts->greys[view], pixels, room, quantiles[view]);
    }
  }
  if (ThreadInBlock() == 0) {
    line =
        settings.match_gain ? LineThrough(quantiles[kLeft], quantiles[kRight]) : GreyLine{4096, 0};
    frame.conditioning->side = blur == PreBlur::kOff ? 0 : blur == PreBlur::kLight ? 27 : 54;
    frame.conditioning->centre = blur == PreBlur::kOff ? 256 : blur == PreBlur::kLight ? 202 : 148;
  }
  SyncBlock();
  const int grey = ThreadInBlock();
  frame.conditioning->right_greys[grey] =
      static_cast<uint8_t>(Clamp((line.gain * grey + line.offset + 2048) >> 12, 0, 255));
}

VS_DEVICE uint8_t Blend(const Conditioning& c, int before, int centre, int after) {
  return static_cast<uint8_t>((c.side * (before + after) + c.centre * centre + 128) >> 8);
}

inline constexpr int kPixelThreads = 128;

// Block y: a row of the left view, then of the right one. Across in three rows, then down.
VS_KERNEL MapAndBlur(const Frame frame) {
  const int x = ThreadInGrid();
  const int view = BlockY() / frame.height;
  const int y = BlockY() % frame.height;
  if (x >= frame.width) return;
  const Conditioning& c = *frame.conditioning;
  const auto at = [&](int column, int row) -> int {
    const uint8_t grey = frame.input[view][row * frame.width + Clamp(column, 0, frame.width - 1)];
    return view == kRight ? c.right_greys[grey] : grey;
  };
  const auto across = [&](int row) {
    const int inside = Clamp(row, 0, frame.height - 1);
    return Blend(c, at(x - 1, inside), at(x, inside), at(x + 1, inside));
  };
  frame.grey[view][y * frame.width + x] = c.side == 0
                                              ? static_cast<uint8_t>(at(x, y))
                                              : Blend(c, across(y - 1), across(y), across(y + 1));
}

VS_KERNEL CopyGreys(const Frame frame) {
  const int pixel = ThreadInGrid();
  if (pixel < frame.width * frame.height)
    frame.grey[BlockY()][pixel] = frame.input[BlockY()][pixel];
}

inline Grid PixelsOfBothViews(const Frame& frame) {
  return {(frame.width + kPixelThreads - 1) / kPixelThreads, 2 * frame.height};
}

inline CommonColumns ColumnsInCommon(const Frame& frame) {
  const int middle = frame.settings.min_disparity + frame.settings.num_disparities / 2;
  const int shift = std::abs(middle) <= frame.width / 2 ? middle : 0;
  return {.begin = {Greater(shift, 0), Greater(-shift, 0)},
          .end = {frame.width + Lesser(shift, 0), frame.width - Greater(shift, 0)}};
}

// input -> grey.
template <class Launch>
void Condition(Launch& launch, const Frame& frame) {
  const SgmSettings& settings = frame.settings;
  if (settings.pre_blur == PreBlur::kOff && !settings.match_gain) {
    launch(&CopyGreys, Grid{(frame.Pixels() + kPixelThreads - 1) / kPixelThreads, 2}, kPixelThreads,
           frame);
    return;
  }
  const CommonColumns columns = ColumnsInCommon(frame);
  if (settings.match_gain) {
    const int blocks = (frame.height + kCountedRows - 1) / kCountedRows;
    launch(&CountGreys, Grid{blocks, 2}, kCountThreads, frame, columns);
  }
  const int across = (frame.width - 2) / kNoiseBlock;
  const int all = across * ((frame.height - 2) / kNoiseBlock);
  if (settings.pre_blur == PreBlur::kAutomatic && all > 0) {
    const int step = Greater(all / 1024, 1);
    const int blocks = (all + step - 1) / step;
    constexpr int kWarps = kPixelThreads / kWarpSize;
    launch(&CountNoise, Grid{(blocks + kWarps - 1) / kWarps, 2}, kPixelThreads, frame, across,
           blocks, step);
  }
  launch(&Decide, Grid{}, kCountThreads, frame, columns);
  launch(&MapAndBlur, PixelsOfBothViews(frame), kPixelThreads, frame);
}

}  // namespace vs::gpu
