#pragma once

#include "engine/base/status.h"
#include "engine/image/stereo_rig.h"

namespace vs {

// Whether `rig` can be a real pair of cameras: sizes of 16..16384 px, all numbers finite, focal
// lengths positive, principal points inside the picture, a proper rotation (orthonormal to 1e-6,
// determinant 1), the right camera to the right of the left one by 0.1 mm .. 100 m and less than
// that above, below or before it. INVALID_ARGUMENT with one fault for each wrong field.
Status ValidateRig(const StereoRig& rig);

}  // namespace vs
