#include "engine/stereo/median_filter.h"

#include <algorithm>

#include "engine/stereo/selection.h"
#include "engine/stereo/widened_rows.h"

namespace vs {
namespace {

constexpr auto kFiltered = static_cast<uint8_t>(InvalidReason::kFiltered);

// Confidence and reasons of a row whose disparities became `out`'s.
void Explain(const DisparityMap& in, int y, DisparityMap* out) {
  const uint16_t* before = in.disparity.Row(y);
  const uint16_t* after = out->disparity.Row(y);
  const uint8_t* confidence = in.confidence.Row(y);
  const uint8_t* reason = in.reason.Row(y);
  uint8_t* new_confidence = out->confidence.Row(y);
  uint8_t* new_reason = out->reason.Row(y);
  const int width = in.disparity.width();
  for (int x = 0; x < width; ++x) {
    // Masks and no branches, so that this vectorises.
    const uint8_t was_valid = before[x] != kInvalidDisparity ? 0xff : 0;
    const uint8_t is_valid = after[x] != kInvalidDisparity ? 0xff : 0;
    const uint8_t kept = std::max(confidence[x], kFilledConfidence);
    new_confidence[x] = kept & is_valid;
    const auto lost = static_cast<uint8_t>((kFiltered & was_valid) | (reason[x] & ~was_valid));
    new_reason[x] = lost & ~is_valid;
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
