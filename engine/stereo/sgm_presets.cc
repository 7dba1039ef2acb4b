#include "engine/stereo/sgm_presets.h"

#include "engine/base/str.h"

namespace vs {
namespace {

void Quality(SgmSettings*) {}

void Strict(SgmSettings* s) {
  s->left_right_lenient = false;
  s->fill_holes = false;
  s->fill_background = false;
  s->median = 3;
}

void Lean(SgmSettings* s) { s->smooth_cost = false; }

void Eight(SgmSettings* s) {
  s->directions = 8;
  s->p2 = 38;
}

void Paper(SgmSettings* s) {
  s->cost = MatchCost::kBirchfieldTomasi;
  s->sobel_cap = 31;
  s->window_width = 3;
  s->window_height = 3;
  s->smooth_cost = false;
  s->directions = 7;
  s->p1 = 4;
  s->p2 = 24;
  s->p2_slope_permille = 0;
  s->left_right_lenient = false;
  s->median = 3;
  s->gated_median = false;
  s->fill_holes = false;
}

void SinglePass(SgmSettings* s) {
  s->smooth_cost = false;
  s->directions = 1;
  s->median = 3;
  s->speckle_size = 0;
  s->gated_median = false;
  s->fill_holes = false;
}

struct Preset {
  std::string_view name;
  void (*apply)(SgmSettings*);
};
constexpr Preset kPresets[] = {{"quality", &Quality}, {"strict", &Strict},
                               {"lean", &Lean},       {"eight", &Eight},
                               {"paper", &Paper},     {"single_pass", &SinglePass}};

}  // namespace

std::vector<std::string_view> SgmPresetNames() {
  std::vector<std::string_view> names;
  for (const Preset& preset : kPresets) names.push_back(preset.name);
  return names;
}

Result<SgmSettings> ApplySgmPreset(std::string_view name, const SgmSettings& base) {
  SgmSettings settings;
  settings.min_disparity = base.min_disparity;
  settings.num_disparities = base.num_disparities;
  std::string known;
  for (const Preset& preset : kPresets) {
    if (preset.name == name) {
      preset.apply(&settings);
      return settings;
    }
    known += Str(known.empty() ? "" : ", ", preset.name);
  }
  return NotFound(Str("there is no preset \"", name, "\"; choose ", known));
}

}  // namespace vs
