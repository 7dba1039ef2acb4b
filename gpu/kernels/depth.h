// From disparities to metres (engine/stereo/depth.h), a thread for each pixel.
#pragma once

#include <limits>

#include "engine/image/disparity_map.h"
#include "gpu/frame.h"
#include "gpu/kernels/rounded_float.h"
#include "gpu/kernels/simt.h"

namespace vs::gpu {

inline constexpr int kDepthThreads = 256;

VS_KERNEL ComputeDepth(const Frame frame, const DeviceMap map) {
  constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
  const int pixel = ThreadInGrid();
  if (pixel >= frame.Pixels()) return;
  const uint16_t stored = map.disparity[pixel];
  const RoundedFloat sum =
      RoundedFloat{static_cast<float>(stored)} + RoundedFloat{frame.depth_rule.shift};
  frame.depth_m[pixel] = stored != kInvalidDisparity && sum.value > 0
                             ? (RoundedFloat{frame.depth_rule.scale} / sum).value
                             : kUnknown;
}

// map -> depth_m, if it is wanted.
template <class Launch>
void MakeDepth(Launch& launch, const Frame& frame, const DeviceMap& map) {
  if (frame.depth_m == nullptr) return;
  launch(&ComputeDepth, Grid{(frame.Pixels() + kDepthThreads - 1) / kDepthThreads}, kDepthThreads,
         frame, map);
}

}  // namespace vs::gpu
