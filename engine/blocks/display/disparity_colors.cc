// Turns disparity into a picture for people.
#include <utility>

#include "engine/base/str.h"
#include "engine/core/block.h"
#include "engine/stereo/color_map.h"

namespace vs {
namespace {

class DisparityColors final : public Block {
 public:
  In<DisparityMap> disparity{this, "disparity", "Any disparity map."};
  Out<ColorImage> picture{this, "picture", "The map in colours."};
  Param<std::string> colors{
      this,
      "colors",
      {.initial = "turbo",
       .choices = {"grey", "hue", "turbo", "viridis"},
       .operator_editable = true,
       .doc = "Grey: near is light. Hue: once round the colour circle, invalid red. Turbo: far is "
              "blue, near is red. Viridis: even steps, for the colour-blind too."}};
  Param<double> far_px{this,
                       "far_px",
                       {.initial = 0,
                        .min = -2048.0,
                        .max = 2304.0,
                        .unit = "px",
                        .operator_editable = true,
                        .doc = "Disparity that gets the colour of the farthest."}};
  Param<double> near_px{this,
                        "near_px",
                        {.initial = 128,
                         .min = -2048.0,
                         .max = 2304.0,
                         .unit = "px",
                         .operator_editable = true,
                         .doc = "Disparity that gets the colour of the nearest."}};

  Status CheckParams() const override {
    if (*far_px < *near_px) return Status();
    return InvalidArgument(
        Str("far_px (", *far_px, ") must be less than near_px (", *near_px, ")"));
  }

  Status Run() override {
    picture.Set(ColorizeDisparity(*disparity, ChosenColors(), *far_px, *near_px, pool()));
    return {};
  }

 private:
  ColorMap ChosenColors() const {
    if (*colors == "grey") return ColorMap::kGrey;
    if (*colors == "hue") return ColorMap::kHue;
    return *colors == "viridis" ? ColorMap::kViridis : ColorMap::kTurbo;
  }
};

VS_REGISTER_BLOCK(DisparityColors,
                  {.category = "Display",
                   .doc = "Shows disparity in colours, so that people can see near and far."});

}  // namespace
}  // namespace vs
