#include "tests/bench/sgm_options.h"

#include <charconv>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "engine/base/str.h"

namespace vs::test {
namespace {

using Field =
    std::variant<int SgmSettings::*, bool SgmSettings::*, MatchCost SgmSettings::*,
                 CensusPattern SgmSettings::*, SubPixel SgmSettings::*, PreBlur SgmSettings::*>;

const std::map<std::string_view, Field>& Fields() {
  using S = SgmSettings;
  static const std::map<std::string_view, Field> fields = {
      {"min_disparity", &S::min_disparity},
      {"num_disparities", &S::num_disparities},
      {"pre_blur", &S::pre_blur},
      {"match_gain", &S::match_gain},
      {"cost", &S::cost},
      {"census", &S::census},
      {"ad_limit", &S::ad_limit},
      {"grey_limit", &S::grey_limit},
      {"sobel_cap", &S::sobel_cap},
      {"outside_cost", &S::outside_cost},
      {"window_width", &S::window_width},
      {"window_height", &S::window_height},
      {"smooth_cost", &S::smooth_cost},
      {"smooth_cost_gate", &S::smooth_cost_gate},
      {"directions", &S::directions},
      {"p1", &S::p1},
      {"p2", &S::p2},
      {"p2_min", &S::p2_min},
      {"p2_slope_permille", &S::p2_slope_permille},
      {"sub_pixel", &S::sub_pixel},
      {"uniqueness_percent", &S::uniqueness_percent},
      {"min_confidence", &S::min_confidence},
      {"left_right_check", &S::left_right_check},
      {"left_right_tolerance", &S::left_right_tolerance},
      {"left_right_lenient", &S::left_right_lenient},
      {"median", &S::median},
      {"speckle_size", &S::speckle_size},
      {"speckle_step", &S::speckle_step},
      {"gated_median", &S::gated_median},
      {"gate", &S::gate},
      {"fill_holes", &S::fill_holes},
      {"fill_background", &S::fill_background},
  };
  return fields;
}

bool Parse(std::string_view text, int* value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), *value);
  return error == std::errc() && end == text.data() + text.size();
}
bool Parse(std::string_view text, bool* value) {
  *value = text == "true" || text == "1";
  return *value || text == "false" || text == "0";
}
template <class Enum>
bool Parse(std::string_view text, Enum* value) {
  const auto& names = ChoiceNames(*value);
  for (size_t k = 0; k < names.size(); ++k) {
    if (names[k] != text) continue;
    *value = static_cast<Enum>(k);
    return true;
  }
  return false;
}

}  // namespace

Status SetSgmField(std::string_view assignment, SgmSettings* settings) {
  const size_t split = assignment.find('=');
  const std::string_view name = assignment.substr(0, split);
  const auto field = Fields().find(name);
  if (split == std::string_view::npos || field == Fields().end()) {
    std::string known;
    for (const auto& [key, unused] : Fields()) known += Str(" ", key);
    return InvalidArgument(Str("\"", assignment, "\" is not NAME=VALUE with a NAME of:", known));
  }
  const std::string_view text = assignment.substr(split + 1);
  const bool parsed =
      std::visit([&](auto member) { return Parse(text, &(settings->*member)); }, field->second);
  if (!parsed) return InvalidArgument(Str("\"", text, "\" is no value for ", name));
  return Status();
}

SgmSettings PlainCensus(int directions) {
  return {.cost = MatchCost::kCensus,
          .census = CensusPattern::k5x5,
          .smooth_cost = false,
          .directions = directions,
          .p1 = 5,
          .p2 = 30,
          .median = 0,
          .speckle_size = 0,
          .gated_median = false,
          .fill_holes = false};
}

}  // namespace vs::test
