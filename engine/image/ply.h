#pragma once

#include <cstdint>
#include <vector>

#include "engine/image/point_cloud.h"

namespace vs {

// The known points, row by row, as a binary PLY file of floats (metres), which every viewer of
// point clouds reads.
std::vector<uint8_t> EncodePly(const PointCloud& cloud);

}  // namespace vs
