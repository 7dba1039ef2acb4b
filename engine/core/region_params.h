#pragma once

#include "engine/core/param.h"
#include "engine/image/pixel_rect.h"

namespace vs {

// The four parameters of a block that looks at a part of its picture only: roi_x, roi_y, roi_width
// and roi_height, px. Initially the whole picture.
class RegionParams {
 public:
  explicit RegionParams(Block* owner) : owner_(owner) {}

  // May reach beyond the picture; see Inside().
  PixelRect operator*() const {
    const auto extent = [](int size) { return size == 0 ? kMax : size; };
    return {*x_, *y_, extent(*width_), extent(*height_)};
  }

 private:
  static constexpr int kMax = 16384;

  static ParamOptions<int> Options(const char* doc) {
    return {
        .initial = 0, .min = 0, .max = kMax, .unit = "px", .operator_editable = true, .doc = doc};
  }

  Block* owner_;
  Param<int> x_{
      owner_, "roi_x",
      Options("Left edge of the region that counts; the rest of the picture is ignored.")};
  Param<int> y_{owner_, "roi_y", Options("Upper edge of the region.")};
  Param<int> width_{owner_, "roi_width",
                    Options("Width of the region; 0 reaches to the right edge.")};
  Param<int> height_{owner_, "roi_height",
                     Options("Height of the region; 0 reaches to the lower edge.")};
};

}  // namespace vs
