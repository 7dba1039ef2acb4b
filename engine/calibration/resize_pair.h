#pragma once

#include "engine/base/recycler.h"
#include "engine/base/status.h"
#include "engine/image/buffer.h"
#include "engine/image/frame.h"

namespace vs {

// Both pictures of a pair at another size, by Resample: 0.5 does what a camera's 2 x 2 binning
// does. The new size is `scale` times the old one, rounded; a rectified pair keeps its geometry,
// scaled. The truth is dropped. INVALID_ARGUMENT when a picture is missing, scale is outside 0.05
// .. 4 or the result would be smaller than 16 px or larger than 16384 px. `frames` and `pool` give
// the memory.
Result<StereoFrame> ResizePair(const StereoFrame& pair, double scale, const Recycler<Frame>& frames,
                               BufferPool& pool);

}  // namespace vs
