#pragma once

#include <string>
#include <utility>

#include "engine/base/str.h"
#include "engine/core/param.h"
#include "engine/image/pixel_rect.h"

namespace vs {

// The four parameters of a block that looks at a part of its picture only: roi_x, roi_y, roi_width
// and roi_height, px. Initially the whole picture.
class RegionParams {
 public:
  // `effect` says what happens to the region, as a user's text: "The region that is judged."
  RegionParams(Block* owner, const char* effect)
      : x_(owner, "roi_x", Options(Str(effect, " Its left edge."))),
        y_(owner, "roi_y", Options("Upper edge of the region.")),
        width_(owner, "roi_width", Options("Width of the region; 0 reaches to the right edge.")),
        height_(owner, "roi_height",
                Options("Height of the region; 0 reaches to the lower edge.")) {}

  // May reach beyond the picture; see Inside().
  PixelRect operator*() const {
    const auto extent = [](int size) { return size == 0 ? kMax : size; };
    return {*x_, *y_, extent(*width_), extent(*height_)};
  }

 private:
  static constexpr int kMax = 16384;

  static ParamOptions<int> Options(std::string doc) {
    return {.initial = 0,
            .min = 0,
            .max = kMax,
            .unit = "px",
            .operator_editable = true,
            .doc = std::move(doc)};
  }

  Param<int> x_;
  Param<int> y_;
  Param<int> width_;
  Param<int> height_;
};

}  // namespace vs
