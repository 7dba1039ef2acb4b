#include "engine/sim/texture.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "engine/sim/hash.h"

namespace vs::sim {
namespace {

struct Octave {
  int cell;  // texels
  float weight;
};
constexpr Octave kOctaves[] = {{2, 0.7f}, {4, 0.7f}, {8, 0.5f}, {16, 0.4f}, {32, 0.4f}};

float Lattice(int octave, int x, int y) {
  const uint64_t key = (static_cast<uint64_t>(octave) << 40) | (static_cast<uint64_t>(y) << 20) |
                       static_cast<uint64_t>(x);
  return static_cast<float>(Hash(key) >> 48) / 32768.0f - 1.0f;
}

float Smooth(float t) { return t * t * (3 - 2 * t); }

float ValueNoise(int index, int cell, int cells, int x, int y) {
  const int x0 = x / cell;
  const int y0 = y / cell;
  const int x1 = (x0 + 1) % cells;
  const int y1 = (y0 + 1) % cells;
  const float fx = Smooth(static_cast<float>(x % cell) / static_cast<float>(cell));
  const float fy = Smooth(static_cast<float>(y % cell) / static_cast<float>(cell));
  const float top = Lattice(index, x0, y0) * (1 - fx) + Lattice(index, x1, y0) * fx;
  const float bottom = Lattice(index, x0, y1) * (1 - fx) + Lattice(index, x1, y1) * fx;
  return top * (1 - fy) + bottom * fy;
}

std::vector<float> MakeTexels(int size) {
  std::vector<float> texels;
  texels.reserve(static_cast<size_t>(size + 1) * (size + 1));
  for (int y = 0; y <= size; ++y) {
    for (int x = 0; x <= size; ++x) {
      float sum = 0;
      int index = 0;
      for (const Octave& octave : kOctaves) {
        sum += octave.weight *
               ValueNoise(index++, octave.cell, size / octave.cell, x % size, y % size);
      }
      texels.push_back(std::clamp(sum, -1.0f, 1.0f));
    }
  }
  return texels;
}

}  // namespace

Texture::Texture() : texels_(Texels()) {}

const float* Texture::Texels() {
  static const std::vector<float> texels = MakeTexels(kSize);
  return texels.data();
}

}  // namespace vs::sim
