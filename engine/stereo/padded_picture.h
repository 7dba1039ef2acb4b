#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/image/image.h"
#include "engine/stereo/sgm_settings.h"

namespace vs {

// The picture that costs are computed from: a copy with kPad pixels added on every side, each equal
// to the nearest pixel of the picture, so that windows need no special case at the border.
class PaddedPicture {
 public:
  static constexpr int kPad = 4;

  // sobel_cap 0: the grey levels. 1..127: the horizontal gradient
  //   2 (I(x+1,y) - I(x-1,y)) + I(x+1,y-1) - I(x-1,y-1) + I(x+1,y+1) - I(x-1,y+1)
  // clipped to +-sobel_cap, plus sobel_cap, as OpenCV's StereoSGBM filters its input; beyond the
  // border the picture goes on with its border pixels. Keeps its memory between calls.
  void Assign(const GreyImage& image, int sobel_cap);

  int width() const { return width_; }
  int height() const { return height_; }
  // x may be -kPad .. width + kPad - 1, y likewise.
  const uint8_t* Row(int y) const {
    return pixels_.data() + static_cast<size_t>(y + kPad) * Stride() + kPad;
  }

 private:
  size_t Stride() const { return static_cast<size_t>(width_) + size_t{2} * kPad; }
  uint8_t* MutableRow(int y) {
    return pixels_.data() + static_cast<size_t>(y + kPad) * Stride() + kPad;
  }
  void Extend();

  int width_ = 0;
  int height_ = 0;
  std::vector<uint8_t> pixels_;
};

}  // namespace vs
