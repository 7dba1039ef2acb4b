#pragma once

#include <cstdint>
#include <vector>

#include "engine/image/image.h"

namespace vs {

enum class Interpolation : uint8_t { kNearest, kLinear, kCubic };

// Where each pixel of a picture comes from in another: whole pixel (x, y) plus 1/32 px.
struct RemapTable {
  struct Source {
    int16_t x;
    int16_t y;
    uint8_t x_part;  // 1/32 px, 0..31
    uint8_t y_part;
  };
  int width = 0;
  int height = 0;
  std::vector<Source> sources;  // row by row
};

// Moves pixels: out(p) = in at table(p), in whole-number arithmetic, the same on every machine.
// What lies outside `in` counts as 0. kCubic is Keys' kernel with a = -0.75. `out` has the table's
// size and shares no memory with `in`; x and y of the table may be anything. No heap memory.
void Remap(const GreyImage& in, const RemapTable& table, Interpolation interpolation,
           GreyImage* out);

}  // namespace vs
