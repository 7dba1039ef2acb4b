// The volume of costs that paths run over (engine/stereo/cost_window.h), a byte a cell.
//
// Each step reads a volume once and writes one: at 648 x 482 and 256 disparities 80 MB each, by an
// H200's data sheet 0.02 ms. Comparing is one bit count a cell, 0.02 ms likewise; the paths, which
// read the volume once for each direction, would have to count the bits as often if there were
// none. So costs are kept, not computed again: by this arithmetic, not by a measurement.
#pragma once

#include <cstdint>
#include <utility>

#include "engine/stereo/pixel_cost.h"
#include "gpu/frame.h"
#include "gpu/kernels/compare.h"
#include "gpu/kernels/simt.h"

namespace vs::gpu {

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
