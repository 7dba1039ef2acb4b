#include "engine/stereo/sgm_settings.h"

#include <string>
#include <utility>
#include <vector>

#include "engine/base/str.h"

namespace vs {
namespace {

class Faults {
 public:
  void Range(const char* field, int value, int min, int max, const char* unit) {
    if (value >= min && value <= max) return;
    Add(field, Str("is ", value, unit, "; it must be ", min, " .. ", max, unit));
  }
  template <class Enum>
  void Choice(const char* field, Enum value, Enum last) {
    if (value <= last) return;
    Add(field,
        Str("is choice ", static_cast<int>(value), "; there are 0 .. ", static_cast<int>(last)));
  }
  void Add(const char* field, std::string message) { list_.push_back({field, std::move(message)}); }

  Status ToStatus() && {
    if (list_.empty()) return {};
    const std::string message = Str("matcher settings: ", list_.size(),
                                    list_.size() == 1 ? " field is wrong" : " fields are wrong");
    return Status(StatusCode::kInvalidArgument, message, std::move(list_));
  }

 private:
  std::vector<Fault> list_;
};

}  // namespace

const std::vector<std::string>& ChoiceNames(MatchCost) {
  static const std::vector<std::string> names = {"birchfield_tomasi", "sad", "census", "ad_census"};
  return names;
}
const std::vector<std::string>& ChoiceNames(CensusPattern) {
  static const std::vector<std::string> names = {"5x5", "7x7", "9x7", "strided_3x3"};
  return names;
}
const std::vector<std::string>& ChoiceNames(SubPixel) {
  static const std::vector<std::string> names = {"off", "parabola", "equiangular"};
  return names;
}
const std::vector<std::string>& ChoiceNames(PreBlur) {
  static const std::vector<std::string> names = {"automatic", "off", "light", "strong"};
  return names;
}

Status ValidateSettings(const SgmSettings& settings) {
  const SgmSettings& s = settings;
  Faults faults;
  faults.Range("min_disparity", s.min_disparity, -2048, 2048, " px");
  faults.Range("num_disparities", s.num_disparities, 1, 256, " px");
  faults.Choice("pre_blur", s.pre_blur, PreBlur::kStrong);
  faults.Choice("cost", s.cost, MatchCost::kAdCensus);
  faults.Choice("census", s.census, CensusPattern::kStrided3x3);
  faults.Range("ad_limit", s.ad_limit, 0, 16, "");
  faults.Range("grey_limit", s.grey_limit, 1, kMaxCost, " grey levels");
  faults.Range("sobel_cap", s.sobel_cap, 0, 127, "");
  faults.Range("outside_cost", s.outside_cost, SgmSettings::kAutomatic, kMaxCost, "");
  faults.Range("window_width", s.window_width, 1, 15, " px");
  faults.Range("window_height", s.window_height, 1, 15, " px");
  faults.Range("smooth_cost_gate", s.smooth_cost_gate, 0, 255, " grey levels");
  faults.Range("directions", s.directions, 1, 8, "");
  faults.Range("p2", s.p2, 0, kMaxP2, "");
  if (s.p1 < 0 || s.p1 > s.p2) {
    faults.Add("p1", Str("is ", s.p1, "; it must be 0 .. p2, which is ", s.p2));
  }
  faults.Range("p2_min", s.p2_min, 0, kMaxP2, "");
  faults.Range("p2_slope_permille", s.p2_slope_permille, 0, 1000, "");
  faults.Choice("sub_pixel", s.sub_pixel, SubPixel::kEquiangular);
  faults.Range("uniqueness_percent", s.uniqueness_percent, 0, 50, " %");
  faults.Range("min_confidence", s.min_confidence, 0, 255, "");
  faults.Range("left_right_tolerance", s.left_right_tolerance, 0, 8, " px");
  if (s.median != 0 && s.median != 3 && s.median != 5) {
    faults.Add("median", Str("is ", s.median, " px; it must be 0 (off), 3 or 5 px"));
  }
  faults.Range("speckle_size", s.speckle_size, 0, 65535, " px");
  faults.Range("speckle_step", s.speckle_step, 1, 16, " px");
  faults.Range("gate", s.gate, 0, 255, " grey levels");
  return std::move(faults).ToStatus();
}

Status ValidateSize(int width, int height) {
  const bool fits = width >= kMinPictureSize && width <= kMaxPictureWidth &&
                    height >= kMinPictureSize && height <= kMaxPictureHeight;
  if (fits) return {};
  return InvalidArgument(Str("matcher: the pictures have ", width, " x ", height,
                             " px; the size must be ", kMinPictureSize, " x ", kMinPictureSize,
                             " to ", kMaxPictureWidth, " x ", kMaxPictureHeight, " px"));
}

Status ValidatePair(const GreyImage& left, const GreyImage& right) {
  if (!left.SameSizeAs(right)) {
    return InvalidArgument(Str("matcher: the left picture has ", left.width(), " x ", left.height(),
                               " px, the right one ", right.width(), " x ", right.height(),
                               " px; they must be equal"));
  }
  return ValidateSize(left.width(), left.height());
}

}  // namespace vs
