#include "engine/blocks/stereo/sgm_params.h"

#include <algorithm>
#include <cmath>

#include "engine/stereo/sgm_presets.h"

namespace vs {
namespace {

// The preset's value stays unless the parameter was changed.
template <class T>
void Take(const Param<T>& param, T* field) {
  if (param.Get() != param.info().initial) *field = *param;
}
template <class Enum>
void TakeChoice(const Param<std::string>& param, Enum* field) {
  if (param.Get() == param.info().initial) return;
  const auto& names = ChoiceNames(*field);
  *field = static_cast<Enum>(std::find(names.begin(), names.end(), *param) - names.begin());
}

}  // namespace

std::vector<std::string> SgmParams::Presets() {
  const auto names = SgmPresetNames();
  return {names.begin(), names.end()};
}

std::string SgmParams::MedianName(int size) {
  return size == 5 ? "5x5" : size == 3 ? "3x3" : "off";
}

SgmSettings SgmParams::Settings() const {
  SgmSettings s = ApplySgmPreset(*preset_).value_or(SgmSettings());
  s.min_disparity = *min_disparity_;
  s.num_disparities = *num_disparities_;
  TakeChoice(pre_blur_, &s.pre_blur);
  Take(match_gain_, &s.match_gain);
  TakeChoice(cost_, &s.cost);
  TakeChoice(census_, &s.census);
  Take(ad_limit_, &s.ad_limit);
  Take(grey_limit_, &s.grey_limit);
  Take(sobel_cap_, &s.sobel_cap);
  Take(outside_cost_, &s.outside_cost);
  Take(window_width_, &s.window_width);
  Take(window_height_, &s.window_height);
  Take(smooth_cost_, &s.smooth_cost);
  Take(smooth_cost_gate_, &s.smooth_cost_gate);
  Take(directions_, &s.directions);
  Take(p1_, &s.p1);
  Take(p2_, &s.p2);
  Take(p2_min_, &s.p2_min);
  if (p2_slope_.Get() != p2_slope_.info().initial) {
    s.p2_slope_permille = static_cast<int>(std::lround(*p2_slope_ * 1000));
  }
  TakeChoice(sub_pixel_, &s.sub_pixel);
  Take(uniqueness_, &s.uniqueness_percent);
  Take(min_confidence_, &s.min_confidence);
  Take(left_right_check_, &s.left_right_check);
  Take(left_right_tolerance_, &s.left_right_tolerance);
  Take(left_right_lenient_, &s.left_right_lenient);
  if (median_.Get() != median_.info().initial) {
    s.median = *median_ == "off" ? 0 : *median_ == "5x5" ? 5 : 3;
  }
  Take(speckle_size_, &s.speckle_size);
  Take(speckle_step_, &s.speckle_step);
  Take(gated_median_, &s.gated_median);
  Take(gate_, &s.gate);
  Take(fill_holes_, &s.fill_holes);
  Take(fill_background_, &s.fill_background);
  return s;
}

}  // namespace vs
