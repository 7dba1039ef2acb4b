#pragma once

#include "engine/image/image.h"
#include "engine/image/rectified_geometry.h"

namespace vs {

// The points that a depth map shows, one for each pixel, so that neighbours stay neighbours. In the
// frame of the rectified left camera: x to the right, y down, z along its axis; metres, all three
// NaN where unknown.
struct PointCloud {
  Image<float> x_m;
  Image<float> y_m;
  Image<float> z_m;
  RectifiedGeometry geometry;
};

}  // namespace vs
