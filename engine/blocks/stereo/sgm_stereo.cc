// Computes disparity from a rectified pair by semi-global matching.
#include <cmath>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/core/block.h"
#include "engine/stereo/match_right_view.h"
#include "engine/stereo/stereo_matcher.h"

namespace vs {
namespace {

std::vector<std::string> Backends() {
  std::vector<std::string> names = StereoMatchers::Get().Names();
  names.insert(names.begin(), "auto");
  return names;
}

// The place of `value` in a list of choices, which are in the order of Enum's values.
template <class Enum>
Enum ChoiceOf(const Param<std::string>& param) {
  const std::vector<std::string>& choices = param.info().choices;
  for (size_t i = 0; i < choices.size(); ++i) {
    if (choices[i] == *param) return static_cast<Enum>(i);
  }
  return Enum{};
}

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

  Param<int> min_disparity{
      this,
      "min_disparity",
      {.initial = 0,
       .min = -2048,
       .max = 2048,
       .unit = "px",
       .operator_editable = true,
       .doc = "Smallest disparity to search: where the farthest point lies. 0 is infinitely far."}};
  Param<int> num_disparities{
      this,
      "num_disparities",
      {.initial = 128,
       .min = 1,
       .max = 256,
       .unit = "px",
       .operator_editable = true,
       .doc = "How many disparities to search: the more, the nearer a point may come and the "
              "longer matching takes."}};

  Param<std::string> cost{
      this,
      "cost",
      {.initial = "ad_census",
       .choices = {"birchfield_tomasi", "sad", "census", "ad_census"},
       .doc = "What pixels are compared by. ad_census is the most accurate; census does not mind "
              "brightness at all; birchfield_tomasi and sad compare grey levels and need cameras "
              "that agree."}};
  Param<std::string> census{this,
                            "census",
                            {.initial = "strided_3x3",
                             .choices = {"5x5", "7x7", "9x7", "strided_3x3"},
                             .doc = "Neighbours that the census costs compare with the centre; "
                                    "larger ones blur edges."}};
  Param<int> ad_limit{
      this,
      "ad_limit",
      {.initial = 4,
       .min = 0,
       .max = 16,
       .doc = "Of ad_census: largest share of the grey difference, in units of four "
              "grey levels."}};
  Param<int> grey_limit{this,
                        "grey_limit",
                        {.initial = 63,
                         .min = 1,
                         .max = 63,
                         .unit = "grey levels",
                         .doc = "Of birchfield_tomasi and sad: larger differences count no more "
                                "than this."}};
  Param<int> sobel_cap{this,
                       "sobel_cap",
                       {.initial = 0,
                        .min = 0,
                        .max = 127,
                        .doc = "Compare horizontal gradients, clipped to this value, in place of "
                               "grey levels; 0 switches it off."}};
  Param<int> outside_cost{
      this,
      "outside_cost",
      {.initial = SgmSettings::kAutomatic,
       .min = SgmSettings::kAutomatic,
       .max = kMaxCost,
       .doc = "Cost of a disparity whose counterpart lies outside the right picture; -1 takes what "
              "fits the chosen cost."}};
  Param<int> window_width{this,
                          "window_width",
                          {.initial = 1,
                           .min = 1,
                           .max = 15,
                           .unit = "px",
                           .doc = "Width of the window over which costs are averaged; P1 and P2 "
                                  "keep their meaning."}};
  Param<int> window_height{this,
                           "window_height",
                           {.initial = 1,
                            .min = 1,
                            .max = 15,
                            .unit = "px",
                            .doc = "Height of the window over which costs are averaged."}};
  Param<bool> smooth_cost{
      this,
      "smooth_cost",
      {.initial = true, .doc = "Average costs over 3 x 3 pixels, but never across an edge."}};
  Param<int> smooth_cost_gate{this,
                              "smooth_cost_gate",
                              {.initial = 6,
                               .min = 0,
                               .max = 255,
                               .unit = "grey levels",
                               .doc = "For smooth_cost: a larger grey step is an edge."}};

  Param<int> directions{this,
                        "directions",
                        {.initial = 4,
                         .min = 1,
                         .max = 8,
                         .doc = "Directions from which paths reach a pixel: from the left, right, "
                                "top, bottom, then the diagonals. One gives streaks."}};
  Param<int> p1{this,
                "p1",
                {.initial = 7,
                 .min = 0,
                 .max = kMaxP2,
                 .operator_editable = true,
                 .doc = "Penalty of a step by one disparity between neighbours: higher is smoother "
                        "on slanted surfaces. At most P2."}};
  Param<int> p2{this,
                "p2",
                {.initial = 34,
                 .min = 0,
                 .max = kMaxP2,
                 .operator_editable = true,
                 .doc = "Penalty of any larger step between neighbours: the higher, the fewer "
                        "jumps and outliers, and the more small things vanish. With P1 and P2 at 0 "
                        "each pixel decides alone."}};
  Param<int> p2_min{this,
                    "p2_min",
                    {.initial = 14,
                     .min = 0,
                     .max = kMaxP2,
                     .doc = "P2 falls no lower than this at a grey edge."}};
  Param<double> p2_slope{this,
                         "p2_slope",
                         {.initial = 0.03,
                          .min = 0.0,
                          .max = 1.0,
                          .unit = "1/grey level",
                          .doc = "How fast P2 falls with the grey step between neighbours, because "
                                 "depth jumps at edges: P2 / (1 + slope * step); 0 keeps P2 "
                                 "constant."}};

  Param<std::string> sub_pixel{this,
                               "sub_pixel",
                               {.initial = "equiangular",
                                .choices = {"off", "parabola", "equiangular"},
                                .doc = "How the disparity is refined to sixteenths of a pixel."}};
  Param<int> uniqueness{this,
                        "uniqueness",
                        {.initial = 0,
                         .min = 0,
                         .max = 50,
                         .unit = "%",
                         .doc = "The best disparity must be this much better than any other, or "
                                "the pixel is ambiguous."}};
  Param<int> min_confidence{this,
                            "min_confidence",
                            {.initial = 0,
                             .min = 0,
                             .max = 255,
                             .operator_editable = true,
                             .doc = "Pixels with less confidence become invalid."}};
  Param<bool> left_right_check{
      this,
      "left_right_check",
      {.initial = true,
       .doc = "Drop pixels for which the right view would choose otherwise: those are hidden from "
              "one camera, or wrong."}};
  Param<int> left_right_tolerance{this,
                                  "left_right_tolerance",
                                  {.initial = 1,
                                   .min = 0,
                                   .max = 8,
                                   .unit = "px",
                                   .doc = "How far the two views may disagree."}};
  Param<bool> left_right_lenient{this,
                                 "left_right_lenient",
                                 {.initial = true,
                                  .doc = "Accept when the neighbour of the counterpart agrees: "
                                         "fewer holes on slanted surfaces."}};

  Param<std::string> median{this,
                            "median",
                            {.initial = "3x3",
                             .choices = {"off", "3x3", "5x5"},
                             .doc = "Median filter against single wrong pixels."}};
  Param<int> speckle_size{this,
                          "speckle_size",
                          {.initial = 60,
                           .min = 0,
                           .max = 65535,
                           .unit = "px",
                           .doc = "Patches of up to this many pixels are removed; 0 keeps all."}};
  Param<int> speckle_step{this,
                          "speckle_step",
                          {.initial = 2,
                           .min = 1,
                           .max = 16,
                           .unit = "px",
                           .doc = "A larger step in disparity separates two patches."}};
  Param<bool> gated_median{this,
                           "gated_median",
                           {.initial = true,
                            .doc = "Median over the neighbours of similar grey: smooths surfaces, "
                                   "keeps edges."}};
  Param<int> gate{this,
                  "gate",
                  {.initial = 20,
                   .min = 0,
                   .max = 255,
                   .unit = "grey levels",
                   .doc = "What counts as similar grey for gated_median and fill_holes."}};
  Param<bool> fill_holes{this,
                         "fill_holes",
                         {.initial = true,
                          .doc = "Fill small holes from neighbours of similar grey that agree. "
                                 "Filled pixels have confidence 1; switch it off for robots."}};
  Param<bool> fill_background{this,
                              "fill_background",
                              {.initial = false,
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
    const auto match = *view == "right" ? MatchRightView : MatchLeftView;
    VS_ASSIGN_OR_RETURN(DisparityMap map, match(*matcher_, pair->left->image, pair->right->image,
                                                Settings(), *threads, pool()));
    if (pair->geometry) map.geometry = *pair->geometry;
    disparity.Set(std::move(map));
    return {};
  }

  void Stop() override { matcher_.reset(); }

 private:
  static Result<DisparityMap> MatchLeftView(StereoMatcher& matcher, const GreyImage& left,
                                            const GreyImage& right, const SgmSettings& settings,
                                            int threads, BufferPool& pool) {
    return matcher.Match(left, right, settings, threads, pool);
  }

  SgmSettings Settings() const {
    SgmSettings s;
    s.min_disparity = *min_disparity;
    s.num_disparities = *num_disparities;
    s.cost = ChoiceOf<MatchCost>(cost);
    s.census = ChoiceOf<CensusPattern>(census);
    s.ad_limit = *ad_limit;
    s.grey_limit = *grey_limit;
    s.sobel_cap = *sobel_cap;
    s.outside_cost = *outside_cost;
    s.window_width = *window_width;
    s.window_height = *window_height;
    s.smooth_cost = *smooth_cost;
    s.smooth_cost_gate = *smooth_cost_gate;
    s.directions = *directions;
    s.p1 = *p1;
    s.p2 = *p2;
    s.p2_min = *p2_min;
    s.p2_slope_permille = static_cast<int>(std::lround(*p2_slope * 1000));
    s.sub_pixel = ChoiceOf<SubPixel>(sub_pixel);
    s.uniqueness_percent = *uniqueness;
    s.min_confidence = *min_confidence;
    s.left_right_check = *left_right_check;
    s.left_right_tolerance = *left_right_tolerance;
    s.left_right_lenient = *left_right_lenient;
    s.median = *median == "off" ? 0 : *median == "5x5" ? 5 : 3;
    s.speckle_size = *speckle_size;
    s.speckle_step = *speckle_step;
    s.gated_median = *gated_median;
    s.gate = *gate;
    s.fill_holes = *fill_holes;
    s.fill_background = *fill_background;
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
