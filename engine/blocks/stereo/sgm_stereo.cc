// Computes disparity from a rectified pair by semi-global matching.
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/core/block.h"
#include "engine/core/region_params.h"
#include "engine/stereo/match_region.h"
#include "engine/stereo/match_right_view.h"
#include "engine/stereo/sgm_presets.h"
#include "engine/stereo/stereo_matcher.h"

namespace vs {
namespace {

std::vector<std::string> Backends() {
  std::vector<std::string> names = StereoMatchers::Get().Names();
  names.insert(names.begin(), "auto");
  return names;
}

std::vector<std::string> Presets() {
  const auto names = SgmPresetNames();
  return {names.begin(), names.end()};
}

constexpr SgmSettings kInitial;

template <class Enum>
std::string NameOf(Enum value) {
  return ChoiceNames(value)[static_cast<size_t>(value)];
}

std::string MedianName(int size) { return size == 5 ? "5x5" : size == 3 ? "3x3" : "off"; }

class SgmStereo final : public Block {
 public:
  In<StereoFrame> pair{this, "pair", "A rectified pair of pictures."};
  Out<DisparityMap> disparity{this, "disparity",
                              "How far each point moves from the left picture to the right one; "
                              "near points move more."};

  Param<std::string> backend{
      this,
      "backend",
      {.initial = "auto",
       .choices = Backends(),
       .live = false,
       .doc = "Who computes: all backends give the same answer, auto takes the fastest."}};
  Param<int> threads{this,
                     "threads",
                     {.initial = 2,
                      .min = 1,
                      .max = 64,
                      .doc = "Processor cores to use; the result does not depend on it."}};
  Param<std::string> view{this,
                          "view",
                          {.initial = "left",
                           .choices = {"left", "right"},
                           .doc = "The picture whose pixels get a disparity. Match both views and "
                                  "compare them with the block LeftRightCheck for the strictest "
                                  "check."}};

  Param<std::string> preset{
      this,
      "preset",
      {.initial = "quality",
       .choices = Presets(),
       .operator_editable = true,
       .doc = "Settings of the method to begin with; of the parameters below, those that differ "
              "from their initial value count instead. quality is the most exact; strict fills "
              "nothing in and suits robots; lean is a little quicker; eight searches 8 directions; "
              "paper is Woodward et al. 2010; single_pass shows what speed is possible."}};
  RegionParams region{this, "The region that is matched; the rest is masked."};

  Param<int> min_disparity{
      this,
      "min_disparity",
      {.initial = kInitial.min_disparity,
       .min = -2048,
       .max = 2048,
       .unit = "px",
       .operator_editable = true,
       .doc = "Smallest disparity to search: where the farthest point lies. 0 is infinitely far."}};
  Param<int> num_disparities{
      this,
      "num_disparities",
      {.initial = kInitial.num_disparities,
       .min = 1,
       .max = 256,
       .unit = "px",
       .operator_editable = true,
       .doc = "How many disparities to search: the more, the nearer a point may come and the "
              "longer matching takes."}};

  Param<std::string> pre_blur{
      this,
      "pre_blur",
      {.initial = NameOf(kInitial.pre_blur),
       .choices = ChoiceNames(PreBlur()),
       .doc = "Smooths both pictures first. automatic does so when they are noisy, as with a high "
              "gain; where there is no noise it only costs detail."}};
  Param<bool> match_gain{this,
                         "match_gain",
                         {.initial = kInitial.match_gain,
                          .doc = "Give the right picture the brightness and contrast of the left "
                                 "one, where they differ much."}};
  Param<std::string> cost{
      this,
      "cost",
      {.initial = NameOf(kInitial.cost),
       .choices = ChoiceNames(MatchCost()),
       .doc = "What pixels are compared by. ad_census is the most accurate; census does not mind "
              "brightness at all; birchfield_tomasi and sad compare grey levels and need cameras "
              "that agree."}};
  Param<std::string> census{this,
                            "census",
                            {.initial = NameOf(kInitial.census),
                             .choices = ChoiceNames(CensusPattern()),
                             .doc = "Neighbours that the census costs compare with the centre; "
                                    "larger ones blur edges."}};
  Param<int> ad_limit{
      this,
      "ad_limit",
      {.initial = kInitial.ad_limit,
       .min = 0,
       .max = 16,
       .doc = "Of ad_census: largest share of the grey difference, in units of four "
              "grey levels."}};
  Param<int> grey_limit{this,
                        "grey_limit",
                        {.initial = kInitial.grey_limit,
                         .min = 1,
                         .max = 63,
                         .unit = "grey levels",
                         .doc = "Of birchfield_tomasi and sad: larger differences count no more "
                                "than this."}};
  Param<int> sobel_cap{this,
                       "sobel_cap",
                       {.initial = kInitial.sobel_cap,
                        .min = 0,
                        .max = 127,
                        .doc = "Compare horizontal gradients, clipped to this value, in place of "
                               "grey levels; 0 switches it off."}};
  Param<int> outside_cost{
      this,
      "outside_cost",
      {.initial = kInitial.outside_cost,
       .min = SgmSettings::kAutomatic,
       .max = kMaxCost,
       .doc = "Cost of a disparity whose counterpart lies outside the right picture; -1 takes what "
              "fits the chosen cost."}};
  Param<int> window_width{this,
                          "window_width",
                          {.initial = kInitial.window_width,
                           .min = 1,
                           .max = 15,
                           .unit = "px",
                           .doc = "Width of the window over which costs are averaged; P1 and P2 "
                                  "keep their meaning."}};
  Param<int> window_height{this,
                           "window_height",
                           {.initial = kInitial.window_height,
                            .min = 1,
                            .max = 15,
                            .unit = "px",
                            .doc = "Height of the window over which costs are averaged."}};
  Param<bool> smooth_cost{this,
                          "smooth_cost",
                          {.initial = kInitial.smooth_cost,
                           .doc = "Average costs over 3 x 3 pixels, but never across an edge."}};
  Param<int> smooth_cost_gate{this,
                              "smooth_cost_gate",
                              {.initial = kInitial.smooth_cost_gate,
                               .min = 0,
                               .max = 255,
                               .unit = "grey levels",
                               .doc = "For smooth_cost: a larger grey step is an edge."}};

  Param<int> directions{this,
                        "directions",
                        {.initial = kInitial.directions,
                         .min = 1,
                         .max = 8,
                         .doc = "Directions from which paths reach a pixel: from the left, right, "
                                "top, bottom, then the diagonals. One gives streaks."}};
  Param<int> p1{this,
                "p1",
                {.initial = kInitial.p1,
                 .min = 0,
                 .max = kMaxP2,
                 .operator_editable = true,
                 .doc = "Penalty of a step by one disparity between neighbours: higher is smoother "
                        "on slanted surfaces. At most P2."}};
  Param<int> p2{this,
                "p2",
                {.initial = kInitial.p2,
                 .min = 0,
                 .max = kMaxP2,
                 .operator_editable = true,
                 .doc = "Penalty of any larger step between neighbours: the higher, the fewer "
                        "jumps and outliers, and the more small things vanish. With P1 and P2 at 0 "
                        "each pixel decides alone."}};
  Param<int> p2_min{this,
                    "p2_min",
                    {.initial = kInitial.p2_min,
                     .min = 0,
                     .max = kMaxP2,
                     .doc = "P2 falls no lower than this at a grey edge."}};
  Param<double> p2_slope{this,
                         "p2_slope",
                         {.initial = kInitial.p2_slope_permille / 1000.0,
                          .min = 0.0,
                          .max = 1.0,
                          .unit = "1/grey level",
                          .doc = "How fast P2 falls with the grey step between neighbours, because "
                                 "depth jumps at edges: P2 / (1 + slope * step); 0 keeps P2 "
                                 "constant."}};

  Param<std::string> sub_pixel{this,
                               "sub_pixel",
                               {.initial = NameOf(kInitial.sub_pixel),
                                .choices = ChoiceNames(SubPixel()),
                                .doc = "How the disparity is refined to sixteenths of a pixel."}};
  Param<int> uniqueness{this,
                        "uniqueness",
                        {.initial = kInitial.uniqueness_percent,
                         .min = 0,
                         .max = 50,
                         .unit = "%",
                         .doc = "The best disparity must be this much better than any other, or "
                                "the pixel is ambiguous."}};
  Param<int> min_confidence{this,
                            "min_confidence",
                            {.initial = kInitial.min_confidence,
                             .min = 0,
                             .max = 255,
                             .operator_editable = true,
                             .doc = "Pixels with less confidence become invalid."}};
  Param<bool> left_right_check{
      this,
      "left_right_check",
      {.initial = kInitial.left_right_check,
       .doc = "Drop pixels for which the right view would choose otherwise: those are hidden from "
              "one camera, or wrong."}};
  Param<int> left_right_tolerance{this,
                                  "left_right_tolerance",
                                  {.initial = kInitial.left_right_tolerance,
                                   .min = 0,
                                   .max = 8,
                                   .unit = "px",
                                   .doc = "How far the two views may disagree."}};
  Param<bool> left_right_lenient{this,
                                 "left_right_lenient",
                                 {.initial = kInitial.left_right_lenient,
                                  .doc = "Accept when the neighbour of the counterpart agrees: "
                                         "fewer holes on slanted surfaces."}};

  Param<std::string> median{this,
                            "median",
                            {.initial = MedianName(kInitial.median),
                             .choices = {"off", "3x3", "5x5"},
                             .doc = "Median filter against single wrong pixels."}};
  Param<int> speckle_size{this,
                          "speckle_size",
                          {.initial = kInitial.speckle_size,
                           .min = 0,
                           .max = 65535,
                           .unit = "px",
                           .doc = "Patches of up to this many pixels are removed; 0 keeps all."}};
  Param<int> speckle_step{this,
                          "speckle_step",
                          {.initial = kInitial.speckle_step,
                           .min = 1,
                           .max = 16,
                           .unit = "px",
                           .doc = "A larger step in disparity separates two patches."}};
  Param<bool> gated_median{this,
                           "gated_median",
                           {.initial = kInitial.gated_median,
                            .doc = "Median over the neighbours of similar grey: smooths surfaces, "
                                   "keeps edges."}};
  Param<int> gate{this,
                  "gate",
                  {.initial = kInitial.gate,
                   .min = 0,
                   .max = 255,
                   .unit = "grey levels",
                   .doc = "What counts as similar grey for gated_median and fill_holes."}};
  Param<bool> fill_holes{this,
                         "fill_holes",
                         {.initial = kInitial.fill_holes,
                          .doc = "Fill small holes from neighbours of similar grey that agree. "
                                 "Filled pixels have confidence 1; switch it off for robots."}};
  Param<bool> fill_background{this,
                              "fill_background",
                              {.initial = kInitial.fill_background,
                               .doc = "Fill all that is left with the farther of its neighbours in "
                                      "the row: a dense map for looking at, not for measuring."}};

  Status CheckParams() const override { return ValidateSettings(Settings()); }

  Status Start() override {
    VS_ASSIGN_OR_RETURN(matcher_, StereoMatchers::Get().Make(*backend));
    return {};
  }

  Status Run() override {
    if (pair->left == nullptr || pair->right == nullptr) {
      return InvalidArgument("a picture of the pair is missing");
    }
    const auto match = *view == "right" ? MatchRightView : MatchRegion;
    VS_ASSIGN_OR_RETURN(DisparityMap map, match(*matcher_, pair->left->image, pair->right->image,
                                                *region, Settings(), *threads, pool()));
    if (pair->geometry) map.geometry = *pair->geometry;
    disparity.Set(std::move(map));
    return {};
  }

  void Stop() override { matcher_.reset(); }

 private:
  // The preset's value stays unless the parameter was changed.
  template <class T>
  static void Take(const Param<T>& param, T* field) {
    if (param.Get() != param.info().initial) *field = *param;
  }
  template <class Enum>
  static void TakeChoice(const Param<std::string>& param, Enum* field) {
    if (param.Get() == param.info().initial) return;
    const auto& names = ChoiceNames(*field);
    *field = static_cast<Enum>(std::find(names.begin(), names.end(), *param) - names.begin());
  }

  SgmSettings Settings() const {
    SgmSettings s = ApplySgmPreset(*preset).value_or(SgmSettings());
    s.min_disparity = *min_disparity;
    s.num_disparities = *num_disparities;
    TakeChoice(pre_blur, &s.pre_blur);
    Take(match_gain, &s.match_gain);
    TakeChoice(cost, &s.cost);
    TakeChoice(census, &s.census);
    Take(ad_limit, &s.ad_limit);
    Take(grey_limit, &s.grey_limit);
    Take(sobel_cap, &s.sobel_cap);
    Take(outside_cost, &s.outside_cost);
    Take(window_width, &s.window_width);
    Take(window_height, &s.window_height);
    Take(smooth_cost, &s.smooth_cost);
    Take(smooth_cost_gate, &s.smooth_cost_gate);
    Take(directions, &s.directions);
    Take(p1, &s.p1);
    Take(p2, &s.p2);
    Take(p2_min, &s.p2_min);
    if (p2_slope.Get() != p2_slope.info().initial) {
      s.p2_slope_permille = static_cast<int>(std::lround(*p2_slope * 1000));
    }
    TakeChoice(sub_pixel, &s.sub_pixel);
    Take(uniqueness, &s.uniqueness_percent);
    Take(min_confidence, &s.min_confidence);
    Take(left_right_check, &s.left_right_check);
    Take(left_right_tolerance, &s.left_right_tolerance);
    Take(left_right_lenient, &s.left_right_lenient);
    if (median.Get() != median.info().initial) {
      s.median = *median == "off" ? 0 : *median == "5x5" ? 5 : 3;
    }
    Take(speckle_size, &s.speckle_size);
    Take(speckle_step, &s.speckle_step);
    Take(gated_median, &s.gated_median);
    Take(gate, &s.gate);
    Take(fill_holes, &s.fill_holes);
    Take(fill_background, &s.fill_background);
    return s;
  }

  std::unique_ptr<StereoMatcher> matcher_;
};

VS_REGISTER_BLOCK(SgmStereo,
                  {.category = "Stereo",
                   .doc = "Finds for each pixel of one picture its counterpart in the other, by "
                          "semi-global matching. Feed it a rectified pair; the initial values suit "
                          "most scenes, P2 and the search range matter most."});

}  // namespace
}  // namespace vs
