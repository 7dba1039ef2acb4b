#pragma once

#include "engine/base/status.h"
#include "engine/image/buffer.h"
#include "engine/image/depth_map.h"
#include "engine/image/disparity_map.h"
#include "engine/image/point_cloud.h"

namespace vs {

// Depth of each valid pixel, NaN elsewhere:
//   depth_m = focal_px * baseline_m / (disparity_px + principal_offset_px)
// A point at or beyond infinity (the sum is not positive) is NaN. FAILED_PRECONDITION when the
// map's geometry is not known (focal length or baseline not positive).
Result<DepthMap> DepthFromDisparity(const DisparityMap& map, BufferPool& pool);

// The point that each pixel (u, v) of known depth z shows:
//   x_m = (u - cx_px) * z / focal_px,  y_m = (v - cy_px) * z / focal_px,  z_m = z
// FAILED_PRECONDITION when the map's geometry is not known.
Result<PointCloud> PointsFromDepth(const DepthMap& map, BufferPool& pool);

}  // namespace vs
