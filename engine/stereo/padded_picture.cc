#include "engine/stereo/padded_picture.h"

#include <algorithm>
#include <cstring>

namespace vs {
namespace {

void SobelRow(const uint8_t* above, const uint8_t* row, const uint8_t* below, int width, int cap,
              uint8_t* out) {
  for (int x = 0; x < width; ++x) {
    const int l = std::max(x - 1, 0);
    const int r = std::min(x + 1, width - 1);
    const int gradient = 2 * (row[r] - row[l]) + above[r] - above[l] + below[r] - below[l];
    out[x] = static_cast<uint8_t>(std::clamp(gradient, -cap, cap) + cap);
  }
}

}  // namespace

void PaddedPicture::Assign(const GreyImage& image, int sobel_cap) {
  width_ = image.width();
  height_ = image.height();
  pixels_.resize(Stride() * (static_cast<size_t>(height_) + size_t{2} * kPad));
  for (int y = 0; y < height_; ++y) {
    if (sobel_cap == 0) {
      std::memcpy(MutableRow(y), image.Row(y), static_cast<size_t>(width_));
    } else {
      SobelRow(image.Row(std::max(y - 1, 0)), image.Row(y), image.Row(std::min(y + 1, height_ - 1)),
               width_, sobel_cap, MutableRow(y));
    }
  }
  Extend();
}

void PaddedPicture::Extend() {
  for (int y = 0; y < height_; ++y) {
    uint8_t* row = MutableRow(y);
    std::memset(row - kPad, row[0], kPad);
    std::memset(row + width_, row[width_ - 1], kPad);
  }
  for (int k = 1; k <= kPad; ++k) {
    std::memcpy(MutableRow(-k) - kPad, MutableRow(0) - kPad, Stride());
    std::memcpy(MutableRow(height_ - 1 + k) - kPad, MutableRow(height_ - 1) - kPad, Stride());
  }
}

}  // namespace vs
