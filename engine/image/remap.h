#pragma once

#include <cstdint>
#include <vector>

#include "engine/image/image.h"

namespace vs {

enum class Interpolation : uint8_t { kNearest, kLinear, kCubic };

// Where each pixel of a picture comes from in another.
struct RemapTable {
  // Whole pixel (x, y) plus 1/32 px.
  struct Source {
    int16_t x;
    int16_t y;
    uint8_t x_part;  // 1/32 px, 0..31
    uint8_t y_part;
  };
  // The place itself, px; anything, what is not a number lies outside.
  struct Position {
    float x;
    float y;
  };
  int width = 0;
  int height = 0;
  // Row by row; one of them is empty.
  std::vector<Source> sources;
  std::vector<Position> positions;
};

// Moves pixels: out(p) = in at table(p); the same on every machine. From sources in whole numbers,
// from positions in floats. What lies outside `in` counts as 0. kCubic is Keys' kernel (1981)
// with a = -0.75. `out` has the table's size and shares no memory with `in`. No heap memory.
void Remap(const GreyImage& in, const RemapTable& table, Interpolation interpolation,
           GreyImage* out);

}  // namespace vs
