#pragma once

#include <cstddef>

namespace vs::sim {

// The random pattern that every surface carries: sums of value noise from 2.5 to 40 mm, so that
// there is structure for any matching window. Cheap to copy.
class Texture {
 public:
  Texture();

  // Between -1 and 1, mean about 0; (u_m, v_m) is a place on the surface in metres. The pattern
  // repeats every 1.28 m.
  float At(float u_m, float v_m) const {
    const Place u(u_m * kTexelsPerMetre);
    const Place v(v_m * kTexelsPerMetre);
    const float* row = &texels_[static_cast<size_t>(v.index) * (kSize + 1) + u.index];
    const float top = row[0] + (row[1] - row[0]) * u.fraction;
    const float bottom = row[kSize + 1] + (row[kSize + 2] - row[kSize + 1]) * u.fraction;
    return top + (bottom - top) * v.fraction;
  }

 private:
  static constexpr int kSize = 1024;  // texels each way, a power of two
  static constexpr float kTexelsPerMetre = 800;

  struct Place {
    int index;       // 0 .. kSize - 1
    float fraction;  // 0 .. 1, towards the next texel

    explicit Place(float texels) {
      const int towards_zero = static_cast<int>(texels);
      const int whole = towards_zero - (texels < static_cast<float>(towards_zero) ? 1 : 0);
      index = whole & (kSize - 1);
      fraction = texels - static_cast<float>(whole);
    }
  };

  static const float* Texels();

  const float* texels_;  // kSize + 1 each way, so that interpolation needs no wrapping
};

}  // namespace vs::sim
