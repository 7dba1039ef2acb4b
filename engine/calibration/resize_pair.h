#pragma once

#include "engine/base/status.h"
#include "engine/image/buffer.h"
#include "engine/image/frame.h"

namespace vs {

// Both pictures of a pair at another size: shrinking averages the pixels that fall on one (0.5 does
// what a camera's 2 x 2 binning does), growing interpolates linearly. The new size is
// `scale` times the old one, rounded; a rectified pair keeps its geometry, scaled. The truth is
// dropped. INVALID_ARGUMENT when a picture is missing, scale is outside 0.05 .. 4 or the result
// would be smaller than 16 px or larger than 16384 px.
Result<StereoFrame> ResizePair(const StereoFrame& pair, double scale, BufferPool& pool);

}  // namespace vs
