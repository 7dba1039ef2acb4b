#include "engine/stereo/depth.h"

#include <limits>

#include "engine/base/str.h"

namespace vs {
namespace {

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

}  // namespace

Status CheckDepthGeometry(const RectifiedGeometry& geometry) {
  if (geometry.focal_px > 0 && geometry.baseline_m > 0) return {};
  return FailedPrecondition(
      Str("depth needs the cameras' geometry, but the focal length is ", geometry.focal_px,
          " px and the baseline ", geometry.baseline_m,
          " m; rectify the pictures with a stereo rig, or give the geometry with the pictures"));
}

DepthRule DepthRuleOf(const RectifiedGeometry& geometry, int offset_px) {
  // depth = f B / (stored / 16 + offset + doffs) = 16 f B / (stored + 16 (offset + doffs))
  return {
      .scale = static_cast<float>(kDisparityScale * geometry.focal_px * geometry.baseline_m),
      .shift = static_cast<float>(kDisparityScale * (offset_px + geometry.principal_offset_px))};
}

Result<DepthMap> DepthFromDisparity(const DisparityMap& map, BufferPool& pool) {
  VS_RETURN_IF_ERROR(CheckDepthGeometry(map.geometry));
  const int width = map.disparity.width();
  const int height = map.disparity.height();
  DepthMap depth{.depth_m = Image<float>(pool, width, height), .geometry = map.geometry};
  const auto [scale, shift] = DepthRuleOf(map.geometry, map.offset_px);
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

Result<PointCloud> PointsFromDepth(const DepthMap& map, BufferPool& pool) {
  VS_RETURN_IF_ERROR(CheckDepthGeometry(map.geometry));
  const int width = map.depth_m.width();
  const int height = map.depth_m.height();
  PointCloud cloud{.x_m = Image<float>(pool, width, height),
                   .y_m = Image<float>(pool, width, height),
                   .z_m = Image<float>(pool, width, height),
                   .geometry = map.geometry};
  const auto per_pixel = static_cast<float>(1 / map.geometry.focal_px);
  const auto cx_px = static_cast<float>(map.geometry.cx_px);
  for (int v = 0; v < height; ++v) {
    const float* depth_m = map.depth_m.Row(v);
    float* x_m = cloud.x_m.Row(v);
    float* y_m = cloud.y_m.Row(v);
    float* z_m = cloud.z_m.Row(v);
    const auto down = static_cast<float>((v - map.geometry.cy_px) / map.geometry.focal_px);
    for (int u = 0; u < width; ++u) {
      const float z = depth_m[u];
      x_m[u] = (static_cast<float>(u) - cx_px) * per_pixel * z;
      y_m[u] = down * z;
      z_m[u] = z;
    }
  }
  return cloud;
}

}  // namespace vs
