#pragma once

#include "engine/base/status.h"
#include "engine/image/buffer.h"
#include "engine/image/depth_map.h"
#include "engine/image/disparity_map.h"
#include "engine/image/point_cloud.h"

namespace vs {

// FAILED_PRECONDITION when depth cannot follow from disparity: focal length or baseline not
// positive.
Status CheckDepthGeometry(const RectifiedGeometry& geometry);

// From stored disparities to metres, in floats:
//   depth_m = scale / (stored + shift), NaN where there is none or the sum is not positive
struct DepthRule {
  float scale = 0;
  float shift = 0;
};
DepthRule DepthRuleOf(const RectifiedGeometry& geometry, int offset_px);

// Depth of each valid pixel, NaN elsewhere:
//   depth_m = focal_px * baseline_m / (disparity_px + principal_offset_px)
// A point at or beyond infinity (the sum is not positive) is NaN. Errors as
// CheckDepthGeometry.
Result<DepthMap> DepthFromDisparity(const DisparityMap& map, BufferPool& pool);

// The point that each pixel (u, v) of known depth z shows:
//   x_m = (u - cx_px) * z / focal_px,  y_m = (v - cy_px) * z / focal_px,  z_m = z
// Errors as CheckDepthGeometry.
Result<PointCloud> PointsFromDepth(const DepthMap& map, BufferPool& pool);

}  // namespace vs
