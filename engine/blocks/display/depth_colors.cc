// Turns depth into a picture for people.
#include <utility>

#include "engine/base/str.h"
#include "engine/core/block.h"
#include "engine/stereo/color_map.h"

namespace vs {
namespace {

class DepthColors final : public Block {
 public:
  In<DepthMap> depth{this, "depth", "Any depth map."};
  Out<ColorImage> picture{this, "picture", "The map in colours."};
  Param<std::string> colors{
      this,
      "colors",
      {.initial = "turbo",
       .choices = {"grey", "hue", "turbo", "viridis"},
       .operator_editable = true,
       .doc = "Grey: near is light. Hue: once round the colour circle, invalid red. Turbo: far is "
              "blue, near is red. Viridis: even steps, for the colour-blind too."}};
  Param<double> near_m{this,
                       "near_m",
                       {.initial = 0.5,
                        .min = 0.0,
                        .max = 1000.0,
                        .unit = "m",
                        .operator_editable = true,
                        .doc = "Depth that gets the colour of the nearest."}};
  Param<double> far_m{this,
                      "far_m",
                      {.initial = 2,
                       .min = 0.0,
                       .max = 1000.0,
                       .unit = "m",
                       .operator_editable = true,
                       .doc = "Depth that gets the colour of the farthest."}};

  Status CheckParams() const override {
    if (*near_m < *far_m) return Status();
    return InvalidArgument(Str("near_m (", *near_m, ") must be less than far_m (", *far_m, ")"));
  }

  Status Run() override {
    picture.Set(ColorizeDepth(*depth, ChosenColors(), *near_m, *far_m, pool()));
    return {};
  }

 private:
  ColorMap ChosenColors() const {
    if (*colors == "grey") return ColorMap::kGrey;
    if (*colors == "hue") return ColorMap::kHue;
    return *colors == "viridis" ? ColorMap::kViridis : ColorMap::kTurbo;
  }
};

VS_REGISTER_BLOCK(DepthColors,
                  {.category = "Display",
                   .doc = "Shows depth in colours, so that people can see near and far."});

}  // namespace
}  // namespace vs
