#pragma once

#include "engine/image/buffer.h"
#include "engine/image/disparity_map.h"

namespace vs {

// Removes small regions: a region is a set of valid pixels connected by the four neighbours whose
// disparities differ by at most `max_step` (1/16 px); one of at most `max_size` pixels becomes
// invalid (InvalidReason::kSpeckle). Works in place; `pool` serves scratch memory only.
// Time is linear in the number of pixels.
void RemoveSpeckles(int max_size, int max_step, BufferPool& pool, DisparityMap* map);

}  // namespace vs
