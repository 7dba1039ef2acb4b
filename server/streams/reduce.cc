#include "server/streams/reduce.h"

#include <algorithm>

namespace vs {
namespace {

int Reduced(int length, int step) { return (length + step - 1) / step; }

// `Count` numbers of 8 bits for each pixel.
template <int Count, class Pixel>
Image<Pixel> MeanOf(const Image<Pixel>& image, int step, BufferPool& pool) {
  Image<Pixel> result(pool, Reduced(image.width(), step), Reduced(image.height(), step));
  for (int y = 0; y < result.height(); ++y) {
    const int rows = std::min(step, image.height() - y * step);
    auto* out = reinterpret_cast<uint8_t*>(result.Row(y));
    for (int x = 0; x < result.width(); ++x) {
      const int columns = std::min(step, image.width() - x * step);
      const auto pixels = static_cast<uint64_t>(rows) * columns;
      for (int channel = 0; channel < Count; ++channel) {
        uint64_t sum = pixels / 2;
        for (int row = 0; row < rows; ++row) {
          const auto* in = reinterpret_cast<const uint8_t*>(image.Row(y * step + row) + x * step);
          for (int column = 0; column < columns; ++column) sum += in[column * Count + channel];
        }
        *out++ = static_cast<uint8_t>(sum / pixels);
      }
    }
  }
  return result;
}

}  // namespace

int ReducingStep(int width, uint32_t max_width_px) {
  if (max_width_px == 0 || static_cast<int64_t>(width) <= int64_t{max_width_px}) return 1;
  return Reduced(width, static_cast<int>(max_width_px));
}

template <class Pixel>
Image<Pixel> Nearest(const Image<Pixel>& image, int step, BufferPool& pool) {
  Image<Pixel> result(pool, Reduced(image.width(), step), Reduced(image.height(), step));
  for (int y = 0; y < result.height(); ++y) {
    const Pixel* in = image.Row(y * step);
    Pixel* out = result.Row(y);
    for (int x = 0; x < result.width(); ++x, in += step) out[x] = *in;
  }
  return result;
}

template Image<uint8_t> Nearest(const Image<uint8_t>&, int, BufferPool&);
template Image<uint16_t> Nearest(const Image<uint16_t>&, int, BufferPool&);
template Image<float> Nearest(const Image<float>&, int, BufferPool&);

GreyImage Mean(const GreyImage& image, int step, BufferPool& pool) {
  return MeanOf<1>(image, step, pool);
}

ColorImage Mean(const ColorImage& image, int step, BufferPool& pool) {
  return MeanOf<3>(image, step, pool);
}

}  // namespace vs
