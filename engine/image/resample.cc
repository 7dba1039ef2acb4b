#include "engine/image/resample.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace vs {
namespace {

// How each pixel of a line is mixed from the pixels of a longer or shorter one: pixel i is the sum
// of weights.Row(i)[tap] times pixel first.Row(0)[i] + tap.
struct Mix {
  Image<int32_t> first;
  Image<float> weights;

  int taps() const { return weights.width(); }
};

// The share of the old pixel [k, k + 1] in the new pixel [begin, begin + step], unnormalised.
double ShareWhenShrinking(int k, double begin, double step) {
  return std::max(0.0, std::min(begin + step, k + 1.0) - std::max<double>(begin, k));
}

double ShareWhenGrowing(int k, double center) { return std::max(0.0, 1 - std::abs(k - center)); }

Mix MakeMix(int from, int to, BufferPool& pool) {
  const bool shrinks = to < from;
  const double step = static_cast<double>(from) / to;
  const int wanted = !shrinks ? 2 : from % to == 0 ? from / to : static_cast<int>(step) + 2;
  const int taps = std::min(wanted, from);
  Mix mix{Image<int32_t>(pool, to, 1), Image<float>(pool, taps, to)};
  for (int i = 0; i < to; ++i) {
    const double begin = i * step;
    const double center = std::clamp(begin + step / 2 - 0.5, 0.0, from - 1.0);
    const int first = std::min(static_cast<int>(shrinks ? begin : center), from - taps);
    mix.first.Row(0)[i] = first;
    double sum = 0;
    for (int tap = 0; tap < taps; ++tap) {
      const double share = shrinks ? ShareWhenShrinking(first + tap, begin, step)
                                   : ShareWhenGrowing(first + tap, center);
      mix.weights.Row(i)[tap] = static_cast<float>(share);
      sum += share;
    }
    for (int tap = 0; tap < taps; ++tap) mix.weights.Row(i)[tap] /= static_cast<float>(sum);
  }
  return mix;
}

// One new row, still as wide as the old ones.
void MixRows(const GreyImage& image, const Mix& mix, int y, float* row) {
  const int width = image.width();
  std::fill(row, row + width, 0.0F);
  for (int tap = 0; tap < mix.taps(); ++tap) {
    const uint8_t* from = image.Row(mix.first.Row(0)[y] + tap);
    const float weight = mix.weights.Row(y)[tap];
    for (int x = 0; x < width; ++x) row[x] += weight * static_cast<float>(from[x]);
  }
}

void MixColumns(const float* row, const Mix& mix, int width, uint8_t* to) {
  const int32_t* first = mix.first.Row(0);
  for (int x = 0; x < width; ++x) {
    const float* weights = mix.weights.Row(x);
    float sum = 0.5F;  // rounds
    for (int tap = 0; tap < mix.taps(); ++tap) sum += weights[tap] * row[first[x] + tap];
    to[x] = static_cast<uint8_t>(std::min(sum, 255.0F));
  }
}

}  // namespace

GreyImage Resample(const GreyImage& image, int width, int height, BufferPool& pool) {
  const Mix columns = MakeMix(image.width(), width, pool);
  const Mix rows = MakeMix(image.height(), height, pool);
  Image<float> row(pool, image.width(), 1);
  GreyImage resampled(pool, width, height);
  for (int y = 0; y < height; ++y) {
    MixRows(image, rows, y, row.Row(0));
    MixColumns(row.Row(0), columns, width, resampled.Row(y));
  }
  return resampled;
}

GreyImage Halved(const GreyImage& image, BufferPool& pool) {
  GreyImage halved(pool, image.width() / 2, image.height() / 2);
  for (int y = 0; y < halved.height(); ++y) {
    const uint8_t* above = image.Row(2 * y);
    const uint8_t* below = image.Row(2 * y + 1);
    uint8_t* row = halved.Row(y);
    const ptrdiff_t width = halved.width();
    for (ptrdiff_t x = 0; x < width; ++x) {
      const int sum = above[2 * x] + above[2 * x + 1] + below[2 * x] + below[2 * x + 1];
      row[x] = static_cast<uint8_t>((sum + 2) / 4);
    }
  }
  return halved;
}

}  // namespace vs
