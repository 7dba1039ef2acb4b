#pragma once

#include <cstdint>

#include "engine/base/status.h"
#include "engine/image/buffer.h"
#include "engine/image/disparity_map.h"

namespace vs {

// Keeps a disparity of the left view where the right view says the same:
//   |left(x, y) - right(x - left(x, y), y)| <= max_difference_px
// with the counterpart's column rounded to the nearest pixel. Otherwise, or when the right view has
// no disparity there, the pixel becomes invalid: kOccluded, or kBorder when its counterpart lies
// outside. `right` holds the disparities of the right view's own pixels, positive to the right.
// INVALID_ARGUMENT when the sizes differ. Eq. 2 of Woodward et al. 2010.
Result<DisparityMap> CheckLeftRight(const DisparityMap& left, const DisparityMap& right,
                                    double max_difference_px, BufferPool& pool);

}  // namespace vs
