#include "engine/stereo/gated_filter.h"

#include <algorithm>
#include <array>
#include <cstdlib>

#include "engine/stereo/selection.h"
#include "engine/stereo/widened_rows.h"

namespace vs {
namespace {

constexpr int kMedianSize = 5;
constexpr int kFillRadius = 3;
constexpr int kFillSize = 2 * kFillRadius + 1;
constexpr int kFillCount = kFillSize * kFillSize;
constexpr int kLeastMembers = 12;
constexpr int kAgreeing = kDisparityScale;  // 1 px

// kInvalidDisparity when the neighbours are too few or disagree.
uint16_t FillValue(const DisparityMap& map, const GreyImage& left, int gate, int x, int y) {
  std::array<uint16_t, kFillCount> members;
  int count = 0;
  const int centre = left.Row(y)[x];
  for (int v = std::max(y - kFillRadius, 0); v <= std::min(y + kFillRadius, left.height() - 1);
       ++v) {
    const uint16_t* disparity = map.disparity.Row(v);
    const uint8_t* grey = left.Row(v);
    for (int u = std::max(x - kFillRadius, 0); u <= std::min(x + kFillRadius, left.width() - 1);
         ++u) {
      if (disparity[u] != kInvalidDisparity && std::abs(grey[u] - centre) <= gate) {
        members[count++] = disparity[u];
      }
    }
  }
  if (count < kLeastMembers) return kInvalidDisparity;
  uint16_t* const begin = members.data();
  std::nth_element(begin, begin + count / 2, begin + count);
  const uint16_t median = begin[count / 2];
  const auto agreeing =
      std::count_if(begin, begin + count, [&](int d) { return std::abs(d - median) <= kAgreeing; });
  return agreeing * 10 >= count * 7 ? median : kInvalidDisparity;
}

// How many valid pixels each fill window of a row has, whatever their grey.
void CountValid(const DisparityMap& in, int y, uint16_t* columns, uint16_t* counts) {
  const int width = in.disparity.width();
  const int top = std::max(y - kFillRadius, 0);
  const int bottom = std::min(y + kFillRadius, in.disparity.height() - 1);
  // With room for the window on both sides.
  std::fill(columns, columns + width + kFillSize, uint16_t{0});
  uint16_t* column = columns + kFillRadius;
  for (int v = top; v <= bottom; ++v) {
    const uint16_t* row = in.disparity.Row(v);
    for (int x = 0; x < width; ++x) {
      column[x] = static_cast<uint16_t>(column[x] + (row[x] != kInvalidDisparity ? 1 : 0));
    }
  }
  for (int x = 0; x < width; ++x) {
    uint16_t count = 0;
    for (int k = 0; k < kFillSize; ++k) count = static_cast<uint16_t>(count + columns[x + k]);
    counts[x] = count;
  }
}

}  // namespace

void GatedFilterRows(const DisparityMap& in, const GreyImage& left,
                     const GatedFilterOptions& options, int begin, int end,
                     GatedFilterScratch* memory, DisparityMap* out, const FilterKernels& kernels) {
  const int width = in.disparity.width();
  const int height = in.disparity.height();
  const auto row_size = static_cast<size_t>(width) + kFillSize;
  memory->rows.resize(row_size * 3);
  uint16_t* const median = memory->rows.data();
  uint16_t* const columns = median + row_size;
  uint16_t* const counts = columns + row_size;
  WidenedRows rows(width, height, kMedianSize, WidenedRows::Border::kZero, &memory->disparities);
  WidenedRows greys(width, height, kMedianSize, WidenedRows::Border::kZero, &memory->greys);
  const uint16_t* around[kMedianSize];
  const uint16_t* greys_around[kMedianSize];
  for (int y = begin; y < end; ++y) {
    uint16_t* disparity = out->disparity.Row(y);
    std::copy_n(in.disparity.Row(y), width, disparity);
    std::copy_n(in.confidence.Row(y), width, out->confidence.Row(y));
    std::copy_n(in.reason.Row(y), width, out->reason.Row(y));
    if (options.median) {
      rows.Load(
          y, [&](int from) { return in.disparity.Row(from); }, around);
      greys.Load(
          y, [&](int from) { return left.Row(from); }, greys_around);
      kernels.gated_median5(around, greys_around, width, options.gate, options.greatest, median);
      for (int x = 0; x < width; ++x) {
        disparity[x] = disparity[x] != kInvalidDisparity ? median[x] : kInvalidDisparity;
      }
    }
    if (!options.fill) continue;
    CountValid(in, y, columns, counts);
    for (int x = 0; x < width; ++x) {
      if (disparity[x] != kInvalidDisparity || counts[x] < kLeastMembers) continue;
      disparity[x] = FillValue(in, left, options.gate, x, y);
      if (disparity[x] == kInvalidDisparity) continue;
      out->confidence.Row(y)[x] = kFilledConfidence;
      out->reason.Row(y)[x] = static_cast<uint8_t>(InvalidReason::kNone);
    }
  }
}

}  // namespace vs
