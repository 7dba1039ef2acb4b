#include "engine/stereo/left_right_check.h"

#include <cmath>

#include "engine/base/str.h"

namespace vs {
namespace {

InvalidReason Judge(double disparity_px, int x, const uint16_t* right, int width,
                    int right_offset_px, double max_difference_px) {
  const long counterpart = std::lround(x - disparity_px);
  if (counterpart < 0 || counterpart >= width) return InvalidReason::kBorder;
  const uint16_t stored = right[counterpart];
  if (stored == kInvalidDisparity) return InvalidReason::kOccluded;
  const double right_px = static_cast<double>(stored) / kDisparityScale + right_offset_px;
  return std::abs(right_px - disparity_px) <= max_difference_px ? InvalidReason::kNone
                                                                : InvalidReason::kOccluded;
}

}  // namespace

Result<DisparityMap> CheckLeftRight(const DisparityMap& left, const DisparityMap& right,
                                    double max_difference_px, BufferPool& pool) {
  const int width = left.disparity.width();
  const int height = left.disparity.height();
  if (!left.disparity.SameSizeAs(right.disparity)) {
    return InvalidArgument(Str("left-right check: the left disparity map has ", width, " x ",
                               height, " px, the right one ", right.disparity.width(), " x ",
                               right.disparity.height(), " px; they must be equal"));
  }
  DisparityMap out{.disparity = Image<uint16_t>(pool, width, height),
                   .confidence = GreyImage(pool, width, height),
                   .reason = GreyImage(pool, width, height),
                   .offset_px = left.offset_px,
                   .geometry = left.geometry};
  for (int y = 0; y < height; ++y) {
    const uint16_t* disparity = left.disparity.Row(y);
    for (int x = 0; x < width; ++x) {
      auto reason = static_cast<InvalidReason>(left.reason.Row(y)[x]);
      if (disparity[x] != kInvalidDisparity) {
        const double disparity_px =
            static_cast<double>(disparity[x]) / kDisparityScale + left.offset_px;
        reason = Judge(disparity_px, x, right.disparity.Row(y), width, right.offset_px,
                       max_difference_px);
      }
      const bool valid = reason == InvalidReason::kNone;
      out.disparity.Row(y)[x] = valid ? disparity[x] : kInvalidDisparity;
      out.confidence.Row(y)[x] = valid ? left.confidence.Row(y)[x] : 0;
      out.reason.Row(y)[x] = static_cast<uint8_t>(reason);
    }
  }
  return out;
}

}  // namespace vs
