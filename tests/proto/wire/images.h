#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "proto/wire/rvl.h"

namespace vs::wire {

// Disparities in 1/16 px as a matcher makes them: slanted planes with steps between them, noise of
// a few sixteenths, and holes.
inline std::vector<uint16_t> DisparityLikeImage(size_t width, size_t height, uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, 1.2);
  std::vector<uint16_t> pixels(width * height);
  for (size_t y = 0; y < height; ++y) {
    for (size_t x = 0; x < width; ++x) {
      const size_t plane = (x / 90 + y / 110) % 5;
      const bool hole = x % 90 < 4 + plane * 3 || random() % 400 == 0;
      const double disparity = 300.0 + 150.0 * plane + 0.11 * x + 0.07 * y + noise(random);
      pixels[y * width + x] = hole ? 0 : static_cast<uint16_t>(std::lround(disparity));
    }
  }
  return pixels;
}

template <class T>
std::vector<uint8_t> Packed(const std::vector<T>& pixels) {
  std::vector<uint8_t> packed(RvlBound(pixels.size()));
  packed.resize(EncodeRvl(pixels.data(), pixels.size(), 1, pixels.size() * sizeof(T), packed));
  return packed;
}

}  // namespace vs::wire
