#include "engine/stereo/median_filter.h"

#include <algorithm>
#include <cstring>

#include "engine/stereo/selection.h"

namespace vs {
namespace {

// Pixels that are filtered at a time, side by side, so that the compiler can use vectors.
constexpr int kLanes = 64;
using Lanes = uint16_t[kLanes];

void Order(Lanes& __restrict low, Lanes& __restrict high) {
  for (int k = 0; k < kLanes; ++k) {
    const uint16_t a = low[k];
    const uint16_t b = high[k];
    low[k] = a < b ? a : b;
    high[k] = a < b ? b : a;
  }
}

// The median of kCount values in each lane; returns its place in `values`. By forgetful selection:
// of any kCount / 2 + 2 values neither the least nor the greatest can be the median, so both are
// forgotten and one value more is looked at, until one is left.
template <int kCount>
const Lanes& MedianOf(Lanes (&values)[kCount]) {
  int first = 0;
  int last = kCount / 2 + 1;
  for (int next = last + 1; last - first >= 2; ++next) {
    for (int k = first + 1; k <= last; ++k) Order(values[first], values[k]);
    for (int k = first + 1; k < last; ++k) Order(values[k], values[last]);
    ++first;
    if (next < kCount) {
      std::memcpy(values[last], values[next], sizeof(Lanes));
    } else {
      --last;
    }
  }
  return values[first];
}

void ApplyMedian(const DisparityMap& in, int y, int x, uint16_t median, DisparityMap* out) {
  const bool was_valid = in.disparity.Row(y)[x] != kInvalidDisparity;
  const bool is_valid = median != kInvalidDisparity;
  uint8_t confidence = in.confidence.Row(y)[x];
  uint8_t reason = in.reason.Row(y)[x];
  if (is_valid && !was_valid) {
    confidence = kFilledConfidence;
    reason = static_cast<uint8_t>(InvalidReason::kNone);
  } else if (was_valid && !is_valid) {
    confidence = 0;
    reason = static_cast<uint8_t>(InvalidReason::kFiltered);
  }
  out->disparity.Row(y)[x] = median;
  out->confidence.Row(y)[x] = confidence;
  out->reason.Row(y)[x] = reason;
}

template <int kSize>
void FilterRows(const DisparityMap& in, int begin, int end, std::vector<uint16_t>* scratch,
                DisparityMap* out) {
  constexpr int kRadius = kSize / 2;
  const int width = in.disparity.width();
  const int height = in.disparity.height();
  // Rows around y with the border repeated, long enough for whole groups of lanes.
  const size_t stride = static_cast<size_t>(width) + size_t{2} * kRadius + kLanes;
  scratch->resize(stride * kSize);
  uint16_t* rows = scratch->data();
  Lanes values[kSize * kSize];
  for (int y = begin; y < end; ++y) {
    for (int k = 0; k < kSize; ++k) {
      const uint16_t* from = in.disparity.Row(std::clamp(y + k - kRadius, 0, height - 1));
      uint16_t* row = rows + k * stride;
      std::fill(row, row + kRadius, from[0]);
      std::memcpy(row + kRadius, from, static_cast<size_t>(width) * sizeof(uint16_t));
      std::fill(row + kRadius + width, row + stride, from[width - 1]);
    }
    for (int x = 0; x < width; x += kLanes) {
      for (int k = 0; k < kSize * kSize; ++k) {
        std::memcpy(values[k], rows + (k / kSize) * stride + x + k % kSize, sizeof(Lanes));
      }
      const Lanes& medians = MedianOf(values);
      const int count = std::min(kLanes, width - x);
      for (int k = 0; k < count; ++k) ApplyMedian(in, y, x + k, medians[k], out);
    }
  }
}

}  // namespace

void MedianFilterRows(const DisparityMap& in, int size, int begin, int end,
                      std::vector<uint16_t>* scratch, DisparityMap* out) {
  if (size == 5) {
    FilterRows<5>(in, begin, end, scratch, out);
  } else {
    FilterRows<3>(in, begin, end, scratch, out);
  }
}

}  // namespace vs
