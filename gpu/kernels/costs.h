// The volume of costs that paths run over (engine/stereo/cost_window.h), a byte a cell.
//
// Each step reads a volume once and writes one: at 648 x 482 and 256 disparities 80 MB each, 0.02
// ms on an H200. Comparing is one bit count a cell, 0.02 ms; the paths, which read the volume once
// for each direction, would have to count the bits as often if there were none.
#pragma once

#include <cstdint>
#include <utility>

#include "engine/stereo/pixel_cost.h"
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

// A block does kTile pixels of a row; the right pixels that they meet wait in shared memory.
inline constexpr int kTile = 32;

template <CostKind kKind>
VS_KERNEL ComparePixels(const Frame frame, int outside, uint8_t* costs) {
  // In an order in which the lanes of a warp, 8 pixels apart, meet different banks.
  constexpr int kColumns = (kTile + 256) / kCostCells + 1;
  VS_SHARED Feature right[kCostCells * kColumns];
  const auto slot = [](int k) { return k % kCostCells * kColumns + k / kCostCells; };
  const int y = BlockY();
  const int x0 = BlockX() * kTile;
  // Right pixel of slot k.
  const int first_right = x0 - frame.settings.min_disparity - (frame.pitch - 1);
  for (int k = ThreadInBlock(); k < kTile + frame.pitch; k += ThreadsInBlock()) {
    const int x = Clamp(first_right + k, 0, frame.width - 1);
    right[slot(k)] = FeatureAt<kKind>(frame, kRight, y * frame.width + x);
  }
  SyncBlock();
  const int groups = frame.pitch / kCostCells;
  for (int item = ThreadInBlock(); item < kTile * groups; item += ThreadsInBlock()) {
    const int x = x0 + item / groups;
    const int first = item % groups * kCostCells;
    if (x >= frame.width) break;
    const Feature left = FeatureAt<kKind>(frame, kLeft, y * frame.width + x);
    CostBytes cells = {};
    for (int k = 0; k < kCostCells; ++k) {
      const Feature& other = right[slot(x - x0 + frame.pitch - 1 - (first + k))];
      const auto cost = static_cast<uint32_t>(CostOf<kKind>(left, other, frame.settings));
      cells.word[k / 4] |= cost << (8 * (k % 4));
    }
    ResetCells(frame, x, first, outside, &cells);
    StoreCost(cells, frame, x, y, first, costs);
  }
}

// Sums of kCostCells cells, as pairs.
struct CostSums {
  uint32_t pairs[kCostCells / 2] = {};

  VS_DEVICE void Add(const CostBytes& cells) { Change(cells, 1); }
  VS_DEVICE void Subtract(const CostBytes& cells) { Change(cells, -1); }
  VS_DEVICE int Of(int k) const {
    return static_cast<int>((pairs[k / 2] >> (16 * (k % 2))) & 0xffff);
  }

 private:
  VS_DEVICE void Change(const CostBytes& cells, int sign) {
    for (int w = 0; w < kCostCells / 2; ++w) {
      const uint32_t two = BytePermute(cells.word[w / 2], 0, w % 2 == 0 ? 0x4140 : 0x4342);
      pairs[w] = sign > 0 ? AddPairs(pairs[w], two) : SubtractPairs(pairs[w], two);
    }
  }
};

// Rows that a thread goes down, so that it sums up a whole window only for the first.
inline constexpr int kWindowRows = 32;

VS_KERNEL AverageWindow(const Frame frame, int outside, const uint8_t* from, uint8_t* to) {
  const SgmSettings& settings = frame.settings;
  const int groups = frame.pitch / kCostCells;
  const int item = ThreadInGrid();
  const int x = item / groups;
  const int first = item % groups * kCostCells;
  if (x >= frame.width) return;
  const auto visit_row = [&](int row, auto visit) {
    const int y = Clamp(row, 0, frame.height - 1);
    for (int k = 0; k < settings.window_width; ++k) {
      const int column = Clamp(x - settings.window_width / 2 + k, 0, frame.width - 1);
      visit(LoadCost(frame, from, column, y, first));
    }
  };
  // (sum + n / 2) / n by a reciprocal, exact for sums below 2^14 (cost_window.cc).
  const auto n = static_cast<uint32_t>(settings.window_width * settings.window_height);
  int shift = 16;
  while (n >> (shift - 15) != 0) ++shift;
  const uint32_t reciprocal = ((1U << shift) + n - 1) / n;

  const int begin = BlockY() * kWindowRows;
  const int end = Lesser(begin + kWindowRows, frame.height);
  const int top = -(settings.window_height / 2);
  CostSums sums;
  for (int k = 0; k < settings.window_height; ++k) {
    visit_row(begin + top + k, [&](const CostBytes& cells) { sums.Add(cells); });
  }
  for (int y = begin; y < end; ++y) {
    CostBytes mean = {};
    for (int k = 0; k < kCostCells; ++k) {
      const uint32_t value = (static_cast<uint32_t>(sums.Of(k)) + n / 2) * reciprocal >> shift;
      mean.word[k / 4] |= (value & 0xff) << (8 * (k % 4));
    }
    ResetCells(frame, x, first, outside, &mean);
    StoreCost(mean, frame, x, y, first, to);
    visit_row(y + top, [&](const CostBytes& cells) { sums.Subtract(cells); });
    visit_row(y + top + settings.window_height, [&](const CostBytes& cells) { sums.Add(cells); });
  }
}

// (a + b + 1) >> 1 of each byte.
VS_HOST_DEVICE uint32_t AverageBytes(uint32_t a, uint32_t b) {
  return (a | b) - (((a ^ b) & 0xfefefefeU) >> 1);
}

VS_DEVICE CostBytes SmoothCells(const CostBytes& before, const CostBytes& centre,
                                const CostBytes& after) {
  CostBytes out;
  for (int w = 0; w < CostBytes::kWords; ++w) {
    out.word[w] = AverageBytes(centre.word[w], AverageBytes(before.word[w], after.word[w]));
  }
  return out;
}

inline constexpr int kSmoothRows = 8;

// The gated 3 x 3: a thread goes down some rows and keeps what it smoothed across in three of them.
VS_KERNEL SmoothCosts(const Frame frame, int outside, const uint8_t* from, uint8_t* to) {
  const int groups = frame.pitch / kCostCells;
  const int item = ThreadInGrid();
  const int x = item / groups;
  const int first = item % groups * kCostCells;
  if (x >= frame.width) return;
  const uint8_t* const grey = frame.grey[kLeft];
  const int gate = frame.settings.smooth_cost_gate;
  const auto alike = [&](int u, int v, int y) {
    return u >= 0 && u < frame.width && v >= 0 && v < frame.height &&
           Distance(grey[y * frame.width + x], grey[v * frame.width + u]) <= gate;
  };
  const auto across = [&](int y) {
    const CostBytes centre = LoadCost(frame, from, x, y, first);
    CostBytes before = centre;
    CostBytes after = centre;
    if (alike(x - 1, y, y)) before = LoadCost(frame, from, x - 1, y, first);
    if (alike(x + 1, y, y)) after = LoadCost(frame, from, x + 1, y, first);
    return SmoothCells(before, centre, after);
  };
  const int begin = BlockY() * kSmoothRows;
  const int end = Lesser(begin + kSmoothRows, frame.height);
  CostBytes here = across(begin);
  CostBytes above = begin > 0 ? across(begin - 1) : here;
  for (int y = begin; y < end; ++y) {
    const CostBytes below = y + 1 < frame.height ? across(y + 1) : here;
    CostBytes smooth =
        SmoothCells(alike(x, y - 1, y) ? above : here, here, alike(x, y + 1, y) ? below : here);
    ResetCells(frame, x, first, outside, &smooth);
    StoreCost(smooth, frame, x, y, first, to);
    above = here;
    here = below;
  }
}

template <class Launch>
void Compare(Launch& launch, const Frame& frame, int outside, uint8_t* costs) {
  const SgmSettings& settings = frame.settings;
  const Grid grid{(frame.width + kTile - 1) / kTile, frame.height};
  const auto compare = [&](auto kernel) {
    launch(kernel, grid, kCostThreads, frame, outside, costs);
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

// code -> costs. Volumes are written in turn so that the last step ends in `costs`.
template <class Launch>
void MakeCosts(Launch& launch, const Frame& frame) {
  const SgmSettings& settings = frame.settings;
  const bool window = settings.window_width * settings.window_height > 1;
  const bool smooth = settings.smooth_cost;
  const int outside = OutsideCost(settings);
  const int items = frame.width * (frame.pitch / kCostCells);
  const int blocks = (items + kCostThreads - 1) / kCostThreads;
  const auto rows = [&](int each) { return (frame.height + each - 1) / each; };
  uint8_t* to = window != smooth ? frame.other_costs : frame.costs;
  uint8_t* from = frame.costs == to ? frame.other_costs : frame.costs;
  Compare(launch, frame, outside, to);
  if (window) {
    std::swap(from, to);
    launch(&AverageWindow, Grid{blocks, rows(kWindowRows)}, kCostThreads, frame, outside, from, to);
  }
  if (smooth) {
    std::swap(from, to);
    launch(&SmoothCosts, Grid{blocks, rows(kSmoothRows)}, kCostThreads, frame, outside, from, to);
  }
}

}  // namespace vs::gpu
