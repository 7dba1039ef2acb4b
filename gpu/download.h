#pragma once

#include <cstddef>

#include "engine/image/buffer.h"
#include "engine/image/image.h"
#include "engine/stereo/stereo_plan.h"
#include "gpu/frame.h"

namespace vs::gpu {

// The one piece of a frame's memory that holds all that is wanted of it: the map that came out of
// the stages, depth, the rectified left picture.
struct Download {
  const std::byte* begin = nullptr;
  size_t size_bytes = 0;
};
Download DownloadOf(const Frame& frame, const DeviceMap& map);

// The result in `bytes`, a copy of that piece on the host, which it shares. `left` is the picture
// that was uploaded.
StereoResult ResultIn(const Buffer& bytes, const StereoPlan& plan, const Frame& frame,
                      const DeviceMap& map, const GreyImage& left);

}  // namespace vs::gpu
