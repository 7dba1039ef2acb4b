#include "engine/stereo/median_filter.h"

#include "engine/stereo/selection.h"
#include "engine/stereo/widened_rows.h"

namespace vs {
namespace {

// Confidence and reasons of a row whose disparities became `out`'s.
void Explain(const DisparityMap& in, int y, DisparityMap* out) {
  const uint16_t* before = in.disparity.Row(y);
  const uint16_t* after = out->disparity.Row(y);
  const uint8_t* confidence = in.confidence.Row(y);
  const uint8_t* reason = in.reason.Row(y);
  uint8_t* new_confidence = out->confidence.Row(y);
  uint8_t* new_reason = out->reason.Row(y);
  for (int x = 0; x < in.disparity.width(); ++x) {
    const bool was_valid = before[x] != kInvalidDisparity;
    const bool is_valid = after[x] != kInvalidDisparity;
    const uint8_t kept = confidence[x] > 0 ? confidence[x] : kFilledConfidence;
    new_confidence[x] = is_valid ? kept : 0;
    const auto lost = static_cast<uint8_t>(was_valid ? InvalidReason::kFiltered
                                                     : static_cast<InvalidReason>(reason[x]));
    new_reason[x] = is_valid ? 0 : lost;
  }
}

}  // namespace

void MedianFilterRows(const DisparityMap& in, int size, int begin, int end,
                      std::vector<uint16_t>* scratch, DisparityMap* out,
                      const FilterKernels& kernels) {
  const int width = in.disparity.width();
  WidenedRows rows(width, in.disparity.height(), size, WidenedRows::Border::kRepeat, scratch);
  const auto median = size == 5 ? kernels.median5 : kernels.median3;
  const uint16_t* around[5];
  for (int y = begin; y < end; ++y) {
    rows.Load(
        y, [&](int from) { return in.disparity.Row(from); }, around);
    median(around, width, out->disparity.Row(y));
    Explain(in, y, out);
  }
}

}  // namespace vs
