#pragma once

#include "engine/image/image.h"
#include "engine/image/rectified_geometry.h"

namespace vs {

// Distance of each pixel of the left view along the optical axis.
struct DepthMap {
  Image<float> depth_m;  // metres; NaN where unknown
  RectifiedGeometry geometry;
};

}  // namespace vs
