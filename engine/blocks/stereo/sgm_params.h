#pragma once

#include <string>
#include <vector>

#include "engine/core/param.h"
#include "engine/core/region_params.h"
#include "engine/image/pixel_rect.h"
#include "engine/stereo/sgm_settings.h"

namespace vs {

// The parameters of a block that matches: what SgmSettings has, named settings to begin with, and
// the region.
class SgmParams {
 public:
  explicit SgmParams(Block* owner) : owner_(owner) {}

  SgmSettings Settings() const;
  PixelRect Region() const { return *region_; }

 private:
  static std::vector<std::string> Presets();
  static std::string MedianName(int size);
  template <class Enum>
  static std::string NameOf(Enum value) {
    return ChoiceNames(value)[static_cast<size_t>(value)];
  }

  static constexpr SgmSettings kInitial{};
  Block* owner_;

  Param<std::string> preset_{
      owner_,
      "preset",
      {.initial = "quality",
       .choices = Presets(),
       .operator_editable = true,
       .doc = "Settings of the method to begin with; of the parameters below, those that differ "
              "from their initial value count instead. quality is the most exact; strict fills "
              "nothing in and suits robots; lean is a little quicker; eight searches 8 directions; "
              "paper is Woodward et al. 2010; single_pass shows what speed is possible."}};
  RegionParams region_{owner_, "The region that is matched; the rest is masked."};

  Param<int> min_disparity_{
      owner_,
      "min_disparity",
      {.initial = kInitial.min_disparity,
       .min = -2048,
       .max = 2048,
       .unit = "px",
       .operator_editable = true,
       .doc = "Smallest disparity to search: where the farthest point lies. 0 is infinitely far."}};
  Param<int> num_disparities_{
      owner_,
      "num_disparities",
      {.initial = kInitial.num_disparities,
       .min = 1,
       .max = 256,
       .unit = "px",
       .operator_editable = true,
       .doc = "How many disparities to search: the more, the nearer a point may come and the "
              "longer matching takes."}};

  Param<std::string> pre_blur_{
      owner_,
      "pre_blur",
      {.initial = NameOf(kInitial.pre_blur),
       .choices = ChoiceNames(PreBlur()),
       .doc = "Smooths both pictures first. automatic does so when they are noisy, as with a high "
              "gain; where there is no noise it only costs detail."}};
  Param<bool> match_gain_{owner_,
                          "match_gain",
                          {.initial = kInitial.match_gain,
                           .doc = "Give the right picture the brightness and contrast of the left "
                                  "one, where they differ much."}};
  Param<std::string> cost_{
      owner_,
      "cost",
      {.initial = NameOf(kInitial.cost),
       .choices = ChoiceNames(MatchCost()),
       .doc = "What pixels are compared by. ad_census is the most accurate; census does not mind "
              "brightness at all; birchfield_tomasi and sad compare grey levels and need cameras "
              "that agree."}};
  Param<std::string> census_{owner_,
                             "census",
                             {.initial = NameOf(kInitial.census),
                              .choices = ChoiceNames(CensusPattern()),
                              .doc = "Neighbours that the census costs compare with the centre; "
                                     "larger ones blur edges."}};
  Param<int> ad_limit_{
      owner_,
      "ad_limit",
      {.initial = kInitial.ad_limit,
       .min = 0,
       .max = 16,
       .doc = "Of ad_census: largest share of the grey difference, in units of four "
              "grey levels."}};
  Param<int> grey_limit_{owner_,
                         "grey_limit",
                         {.initial = kInitial.grey_limit,
                          .min = 1,
                          .max = 63,
                          .unit = "grey levels",
                          .doc = "Of birchfield_tomasi and sad: larger differences count no more "
                                 "than this."}};
  Param<int> sobel_cap_{owner_,
                        "sobel_cap",
                        {.initial = kInitial.sobel_cap,
                         .min = 0,
                         .max = 127,
                         .doc = "Compare horizontal gradients, clipped to this value, in place of "
                                "grey levels; 0 switches it off."}};
  Param<int> outside_cost_{
      owner_,
      "outside_cost",
      {.initial = kInitial.outside_cost,
       .min = SgmSettings::kAutomatic,
       .max = kMaxCost,
       .doc = "Cost of a disparity whose counterpart lies outside the right picture; -1 takes what "
              "fits the chosen cost."}};
  Param<int> window_width_{owner_,
                           "window_width",
                           {.initial = kInitial.window_width,
                            .min = 1,
                            .max = 15,
                            .unit = "px",
                            .doc = "Width of the window over which costs are averaged; P1 and P2 "
                                   "keep their meaning."}};
  Param<int> window_height_{owner_,
                            "window_height",
                            {.initial = kInitial.window_height,
                             .min = 1,
                             .max = 15,
                             .unit = "px",
                             .doc = "Height of the window over which costs are averaged."}};
  Param<bool> smooth_cost_{owner_,
                           "smooth_cost",
                           {.initial = kInitial.smooth_cost,
                            .doc = "Average costs over 3 x 3 pixels, but never across an edge."}};
  Param<int> smooth_cost_gate_{owner_,
                               "smooth_cost_gate",
                               {.initial = kInitial.smooth_cost_gate,
                                .min = 0,
                                .max = 255,
                                .unit = "grey levels",
                                .doc = "For smooth_cost: a larger grey step is an edge."}};

  Param<int> directions_{owner_,
                         "directions",
                         {.initial = kInitial.directions,
                          .min = 1,
                          .max = 8,
                          .doc = "Directions from which paths reach a pixel: from the left, right, "
                                 "top, bottom, then the diagonals. One gives streaks."}};
  Param<int> p1_{
      owner_,
      "p1",
      {.initial = kInitial.p1,
       .min = 0,
       .max = kMaxP2,
       .operator_editable = true,
       .doc = "Penalty of a step by one disparity between neighbours: higher is smoother "
              "on slanted surfaces. At most P2."}};
  Param<int> p2_{
      owner_,
      "p2",
      {.initial = kInitial.p2,
       .min = 0,
       .max = kMaxP2,
       .operator_editable = true,
       .doc = "Penalty of any larger step between neighbours: the higher, the fewer "
              "jumps and outliers, and the more small things vanish. With P1 and P2 at 0 "
              "each pixel decides alone."}};
  Param<int> p2_min_{owner_,
                     "p2_min",
                     {.initial = kInitial.p2_min,
                      .min = 0,
                      .max = kMaxP2,
                      .doc = "P2 falls no lower than this at a grey edge."}};
  Param<double> p2_slope_{
      owner_,
      "p2_slope",
      {.initial = kInitial.p2_slope_permille / 1000.0,
       .min = 0.0,
       .max = 1.0,
       .unit = "1/grey level",
       .doc = "How fast P2 falls with the grey step between neighbours, because "
              "depth jumps at edges: P2 / (1 + slope * step); 0 keeps P2 "
              "constant."}};

  Param<std::string> sub_pixel_{owner_,
                                "sub_pixel",
                                {.initial = NameOf(kInitial.sub_pixel),
                                 .choices = ChoiceNames(SubPixel()),
                                 .doc = "How the disparity is refined to sixteenths of a pixel."}};
  Param<int> uniqueness_{owner_,
                         "uniqueness",
                         {.initial = kInitial.uniqueness_percent,
                          .min = 0,
                          .max = 50,
                          .unit = "%",
                          .doc = "The best disparity must be this much better than any other, or "
                                 "the pixel is ambiguous."}};
  Param<int> min_confidence_{owner_,
                             "min_confidence",
                             {.initial = kInitial.min_confidence,
                              .min = 0,
                              .max = 255,
                              .operator_editable = true,
                              .doc = "Pixels with less confidence become invalid."}};
  Param<bool> left_right_check_{
      owner_,
      "left_right_check",
      {.initial = kInitial.left_right_check,
       .doc = "Drop pixels for which the right view would choose otherwise: those are hidden from "
              "one camera, or wrong."}};
  Param<int> left_right_tolerance_{owner_,
                                   "left_right_tolerance",
                                   {.initial = kInitial.left_right_tolerance,
                                    .min = 0,
                                    .max = 8,
                                    .unit = "px",
                                    .doc = "How far the two views may disagree."}};
  Param<bool> left_right_lenient_{owner_,
                                  "left_right_lenient",
                                  {.initial = kInitial.left_right_lenient,
                                   .doc = "Accept when the neighbour of the counterpart agrees: "
                                          "fewer holes on slanted surfaces."}};

  Param<std::string> median_{owner_,
                             "median",
                             {.initial = MedianName(kInitial.median),
                              .choices = {"off", "3x3", "5x5"},
                              .doc = "Median filter against single wrong pixels."}};
  Param<int> speckle_size_{owner_,
                           "speckle_size",
                           {.initial = kInitial.speckle_size,
                            .min = 0,
                            .max = 65535,
                            .unit = "px",
                            .doc = "Patches of up to this many pixels are removed; 0 keeps all."}};
  Param<int> speckle_step_{owner_,
                           "speckle_step",
                           {.initial = kInitial.speckle_step,
                            .min = 1,
                            .max = 16,
                            .unit = "px",
                            .doc = "A larger step in disparity separates two patches."}};
  Param<bool> gated_median_{owner_,
                            "gated_median",
                            {.initial = kInitial.gated_median,
                             .doc = "Median over the neighbours of similar grey: smooths surfaces, "
                                    "keeps edges."}};
  Param<int> gate_{owner_,
                   "gate",
                   {.initial = kInitial.gate,
                    .min = 0,
                    .max = 255,
                    .unit = "grey levels",
                    .doc = "What counts as similar grey for gated_median and fill_holes."}};
  Param<bool> fill_holes_{owner_,
                          "fill_holes",
                          {.initial = kInitial.fill_holes,
                           .doc = "Fill small holes from neighbours of similar grey that agree. "
                                  "Filled pixels have confidence 1; switch it off for robots."}};
  Param<bool> fill_background_{
      owner_,
      "fill_background",
      {.initial = kInitial.fill_background,
       .doc = "Fill all that is left with the farther of its neighbours in "
              "the row: a dense map for looking at, not for measuring."}};
};

}  // namespace vs
