#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "engine/base/status.h"
#include "engine/image/stereo_rig.h"

namespace vs {

// A stereo rig as JSON that people can read and compare. Canonical: the same rig gives the
// same bytes (keys sorted, numbers in the shortest form that reads back exactly).
//
//   { "format": "visionserver.stereo_rig", "version": 1, "name": "cell 3",
//     "left":  {"width": 1296, "height": 966, "fx_px": ..., "fy_px": ..., "cx_px": ..., "cy_px":
//     ...,
//               "k1": ..., "k2": ..., "p1": ..., "p2": ..., "k3": ...},
//     "right": {...},
//     "right_from_left": {"rotation": [9 numbers, row by row], "translation_m": [x, y, z]} }
//
// A key that is missing, unknown or there twice is an error: a misspelt one must not pass silently.

// Longer texts are refused.
inline constexpr size_t kLargestRigBytes = size_t{64} * 1024;

std::string FormatRig(const StereoRig& rig);
// INVALID_ARGUMENT with one fault for each wrong field ("left.fx_px"); for text that is no JSON at
// all, with line and column. The rig is validated.
Result<StereoRig> ParseRig(std::string_view text);

}  // namespace vs
