#pragma once

#include <cstdint>
#include <vector>

#include "engine/image/image.h"

namespace vs {

// A depth map as whole numbers of equal steps.
struct DepthSteps {
  std::vector<uint16_t> steps;  // row by row; 0 where unknown
  double step_m = 0;
};

// Rounds to the smallest step of 0.1, 0.2, 0.5, 1, 2 ... mm with which the farthest pixel still
// fits into 16 bits, so the error is at most half of that. What is not a positive finite number, or
// farther than 1000 km, is unknown. O(pixels); keeps the memory of `result`.
void ToSteps(const Image<float>& depth_m, DepthSteps* result);

}  // namespace vs
