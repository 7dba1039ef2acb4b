#include "engine/stereo/depth.h"

#include <limits>

#include "engine/base/str.h"

namespace vs {
namespace {

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

Status CheckGeometry(const RectifiedGeometry& geometry) {
  if (geometry.focal_px > 0 && geometry.baseline_m > 0) return {};
  return FailedPrecondition(
      Str("depth needs the cameras' geometry, but the focal length is ", geometry.focal_px,
          " px and the baseline ", geometry.baseline_m,
          " m; rectify the pictures with a stereo rig, or give the geometry with the pictures"));
}

}  // namespace

Result<DepthMap> DepthFromDisparity(const DisparityMap& map, BufferPool& pool) {
  VS_RETURN_IF_ERROR(CheckGeometry(map.geometry));
  const int width = map.disparity.width();
  const int height = map.disparity.height();
  DepthMap depth{.depth_m = Image<float>(pool, width, height), .geometry = map.geometry};
  // depth = f B / (stored / 16 + offset + doffs) = 16 f B / (stored + 16 (offset + doffs))
  const auto scale =
      static_cast<float>(kDisparityScale * map.geometry.focal_px * map.geometry.baseline_m);
  const auto shift =
      static_cast<float>(kDisparityScale * (map.offset_px + map.geometry.principal_offset_px));
  for (int y = 0; y < height; ++y) {
    const uint16_t* disparity = map.disparity.Row(y);
    float* out = depth.depth_m.Row(y);
    for (int x = 0; x < width; ++x) {
      const float sum = static_cast<float>(disparity[x]) + shift;
      // The choice before the division, so that this vectorises: what is unknown stays so.
      out[x] = scale / (disparity[x] != kInvalidDisparity && sum > 0 ? sum : kUnknown);
    }
  }
  return depth;
}

}  // namespace vs
