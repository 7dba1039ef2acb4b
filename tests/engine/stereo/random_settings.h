#pragma once

#include <random>
#include <sstream>
#include <string>

#include "engine/stereo/sgm_settings.h"
#include "tests/engine/stereo/pictures.h"

namespace vs {

// Valid settings from everywhere in the allowed ranges, extremes included.
inline SgmSettings MakeRandomSettings(std::mt19937& random, int largest_range) {
  const auto pick = [&](int min, int max) {
    const int dice = Below(random, 6);
    if (dice == 0) return min;
    return dice == 1 ? max : min + Below(random, max - min + 1);
  };
  SgmSettings s;
  s.min_disparity = pick(-12, 20);
  s.num_disparities = pick(1, largest_range);
  s.pre_blur = static_cast<PreBlur>(Below(random, 4));
  s.match_gain = Below(random, 2) == 0;
  s.cost = static_cast<MatchCost>(Below(random, 4));
  s.census = static_cast<CensusPattern>(Below(random, 4));
  s.ad_limit = pick(0, 16);
  s.grey_limit = pick(1, 63);
  s.sobel_cap = Below(random, 3) == 0 ? pick(1, 127) : 0;
  s.outside_cost = pick(-1, 63);
  s.window_width = Below(random, 2) == 0 ? 1 : pick(1, 15);
  s.window_height = Below(random, 2) == 0 ? 1 : pick(1, 15);
  s.smooth_cost = Below(random, 2) == 0;
  s.smooth_cost_gate = pick(0, 255);
  s.directions = pick(1, 8);
  s.p2 = pick(0, 64);
  s.p1 = Below(random, s.p2 + 1);
  s.p2_min = pick(0, 64);
  s.p2_slope_permille = pick(0, 1000);
  s.sub_pixel = static_cast<SubPixel>(Below(random, 3));
  s.uniqueness_percent = pick(0, 50);
  s.min_confidence = Below(random, 3) == 0 ? pick(0, 255) : 0;
  s.left_right_check = Below(random, 4) != 0;
  s.left_right_tolerance = pick(0, 8);
  s.left_right_lenient = Below(random, 2) == 0;
  s.median = std::array{0, 3, 5}[Below(random, 3)];
  s.speckle_size = Below(random, 2) == 0 ? 0 : pick(1, 80);
  s.speckle_step = pick(1, 16);
  s.gated_median = Below(random, 2) == 0;
  s.gate = pick(0, 255);
  s.fill_holes = Below(random, 2) == 0;
  s.fill_background = Below(random, 4) == 0;
  return s;
}

// For the message of a failing test.
inline std::string Describe(const SgmSettings& s) {
  std::ostringstream text;
  text << "range " << s.min_disparity << " + " << s.num_disparities << ", blur "
       << static_cast<int>(s.pre_blur) << " gain " << s.match_gain << ", cost "
       << static_cast<int>(s.cost) << " census " << static_cast<int>(s.census) << " ad "
       << s.ad_limit << " grey " << s.grey_limit << " sobel " << s.sobel_cap << " outside "
       << s.outside_cost << ", window " << s.window_width << " x " << s.window_height << " smooth "
       << s.smooth_cost << "/" << s.smooth_cost_gate << ", directions " << s.directions << " p "
       << s.p1 << " " << s.p2 << " " << s.p2_min << " " << s.p2_slope_permille << ", sub-pixel "
       << static_cast<int>(s.sub_pixel) << " uniqueness " << s.uniqueness_percent << " confidence "
       << s.min_confidence << ", left-right " << s.left_right_check << "/" << s.left_right_tolerance
       << "/" << s.left_right_lenient << ", median " << s.median << " speckle " << s.speckle_size
       << "/" << s.speckle_step << " gated " << s.gated_median << "/" << s.gate << " fill "
       << s.fill_holes << s.fill_background;
  return text.str();
}

}  // namespace vs
