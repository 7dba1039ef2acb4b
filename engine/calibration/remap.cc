#include "engine/calibration/remap.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace vs {
namespace {

constexpr int kParts = 32;  // of a pixel

// The weights of the `kTaps` pixels about a position, for each part of a pixel.
template <int kTaps>
struct Weights {
  static constexpr int kFirst = -(kTaps / 2 - 1);  // the first tap, from the whole pixel
  std::array<std::array<int, kTaps>, kParts> of_part;
  int bits;  // the weights' sum is 2^bits
};

constexpr Weights<2> LinearWeights() {
  Weights<2> weights{};
  weights.bits = 5;
  for (int part = 0; part < kParts; ++part) weights.of_part[part] = {kParts - part, part};
  return weights;
}

// Keys, "Cubic Convolution Interpolation for Digital Image Processing", 1981, with a = -3/4. In
// 1/32 px, with s = 32 - t, the weights times 2^17 are whole numbers.
constexpr Weights<4> CubicWeights() {
  Weights<4> weights{};
  weights.bits = 17;
  for (int t = 0; t < kParts; ++t) {
    const int s = kParts - t;
    weights.of_part[t] = {-3 * t * s * s, (5 * t - 9 * kParts) * t * t + (1 << 17),
                          (5 * s - 9 * kParts) * s * s + (1 << 17), -3 * s * t * t};
  }
  return weights;
}

template <int kTaps>
uint8_t Interpolate(const GreyImage& in, const RemapTable::Source& source,
                    const Weights<kTaps>& weights) {
  const std::array<int, kTaps>& across = weights.of_part[source.x_part];
  const std::array<int, kTaps>& down = weights.of_part[source.y_part];
  const int x0 = source.x + weights.kFirst;
  const int y0 = source.y + weights.kFirst;
  const bool inside = x0 >= 0 && y0 >= 0 && x0 + kTaps <= in.width() && y0 + kTaps <= in.height();
  int64_t sum = 0;
  for (int v = 0; v < kTaps; ++v) {
    int64_t row_sum = 0;
    if (inside) {
      const uint8_t* row = in.Row(y0 + v) + x0;
      for (int u = 0; u < kTaps; ++u) row_sum += across[u] * row[u];
    } else if (y0 + v >= 0 && y0 + v < in.height()) {
      const uint8_t* row = in.Row(y0 + v);
      for (int u = 0; u < kTaps; ++u) {
        if (x0 + u >= 0 && x0 + u < in.width()) row_sum += across[u] * row[x0 + u];
      }
    }
    sum += down[v] * row_sum;
  }
  const int64_t half = int64_t{1} << (2 * weights.bits - 1);
  const int64_t rounded = (sum + half) >> (2 * weights.bits);
  return static_cast<uint8_t>(std::clamp<int64_t>(rounded, 0, 255));
}

// The same for two taps, and for almost all pixels: one that lies inside with its neighbours.
uint8_t Linear(const GreyImage& in, const RemapTable::Source& source, const Weights<2>& weights) {
  const bool inside = static_cast<unsigned>(source.x) < static_cast<unsigned>(in.width() - 1) &&
                      static_cast<unsigned>(source.y) < static_cast<unsigned>(in.height() - 1);
  if (!inside) return Interpolate(in, source, weights);
  const uint8_t* above = in.Row(source.y) + source.x;
  const uint8_t* below = above + in.stride_bytes();
  const int top = kParts * above[0] + source.x_part * (above[1] - above[0]);
  const int bottom = kParts * below[0] + source.x_part * (below[1] - below[0]);
  const int sum = kParts * top + source.y_part * (bottom - top);
  return static_cast<uint8_t>((sum + kParts * kParts / 2) / (kParts * kParts));
}

uint8_t Nearest(const GreyImage& in, const RemapTable::Source& source) {
  const int x = source.x + (source.x_part >= kParts / 2 ? 1 : 0);
  const int y = source.y + (source.y_part >= kParts / 2 ? 1 : 0);
  const bool inside = x >= 0 && y >= 0 && x < in.width() && y < in.height();
  return inside ? in.Row(y)[x] : uint8_t{0};
}

template <class PixelOf>
void ForEachPixel(const RemapTable& table, GreyImage* out, PixelOf pixel_of) {
  const RemapTable::Source* source = table.sources.data();
  for (int y = 0; y < table.height; ++y) {
    uint8_t* row = out->Row(y);
    for (int x = 0; x < table.width; ++x) row[x] = pixel_of(*source++);
  }
}

}  // namespace

void Remap(const GreyImage& in, const RemapTable& table, Interpolation interpolation,
           GreyImage* out) {
  using Source = RemapTable::Source;
  switch (interpolation) {
    case Interpolation::kNearest:
      return ForEachPixel(table, out, [&](const Source& source) { return Nearest(in, source); });
    case Interpolation::kLinear: {
      static constexpr Weights<2> kWeights = LinearWeights();
      return ForEachPixel(table, out,
                          [&](const Source& source) { return Linear(in, source, kWeights); });
    }
    case Interpolation::kCubic: {
      static constexpr Weights<4> kWeights = CubicWeights();
      return ForEachPixel(table, out,
                          [&](const Source& source) { return Interpolate(in, source, kWeights); });
    }
  }
}

}  // namespace vs
