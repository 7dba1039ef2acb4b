#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/base/status.h"
#include "engine/stereo/sgm_settings.h"

namespace vs {

// Sets of settings that are worth a name, each chosen once for all scenes. They leave the search
// range alone.
//   quality      the default: the most exact for its time
//   strict       nothing is filled in and both views must agree exactly: for robots
//   lean         quality without smoothing the costs: nearly as exact, quicker
//   eight        quality with all 8 directions
//   paper        Woodward et al. 2010: Birchfield-Tomasi on gradients, 7 directions, plain checks
//   single_pass  one direction: for demonstrations of speed
std::vector<std::string_view> SgmPresetNames();

// `base` with the preset's values. NOT_FOUND names the presets that there are.
Result<SgmSettings> ApplySgmPreset(std::string_view name, const SgmSettings& base = {});

}  // namespace vs
