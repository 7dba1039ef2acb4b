#include "engine/stereo/color_map.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace vs {
namespace {

uint8_t ToByte(double value) {
  return static_cast<uint8_t>(std::lround(255 * std::clamp(value, 0.0, 1.0)));
}

// c0 + c1 t + c2 t^2 + ...
double Polynomial(std::initializer_list<double> coefficients, double t) {
  double sum = 0;
  double power = 1;
  for (const double c : coefficients) {
    sum += c * power;
    power *= t;
  }
  return sum;
}

Rgb Grey(double t) { return {ToByte(t), ToByte(t), ToByte(t)}; }

// Saturation and value 1. The hue runs from red, which invalid pixels have too, over yellow, green
// and blue to magenta at 300 degrees, so that near does not look like invalid again.
Rgb Hue(double t) {
  const double sextant = 5 * t;
  const double rise = sextant - std::floor(sextant);
  switch (static_cast<int>(sextant)) {
    case 0:
      return {255, ToByte(rise), 0};
    case 1:
      return {ToByte(1 - rise), 255, 0};
    case 2:
      return {0, 255, ToByte(rise)};
    case 3:
      return {0, ToByte(1 - rise), 255};
    case 4:
      return {ToByte(rise), 0, 255};
    default:
      return {255, 0, 255};
  }
}

// Polynomials published by A. Mikhailov with "Turbo, An Improved Rainbow Colormap", Google, 2019.
Rgb Turbo(double t) {
  return {
      ToByte(Polynomial(
          {0.13572138, 4.61539260, -42.66032258, 132.13108234, -152.94239396, 59.28637943}, t)),
      ToByte(Polynomial({0.09140261, 2.19418839, 4.84296658, -14.18503333, 4.27729857, 2.82956604},
                        t)),
      ToByte(Polynomial(
          {0.10667330, 12.64194608, -60.58204836, 110.36276771, -89.90310912, 27.34824973}, t))};
}

// The polynomials that M. Zucker fitted to matplotlib's viridis (S. van der Walt, N. Smith, 2015).
Rgb Viridis(double t) {
  return {ToByte(Polynomial(
              {0.2777273272234177, 0.1050930431085774, -0.3308618287255563, -4.634230498983486,
               6.228269936347081, 4.776384997670288, -5.435455855934631},
              t)),
          ToByte(Polynomial(
              {0.005407344544966578, 1.404613529898575, 0.214847559468213, -5.799100973351585,
               14.17993336680509, -13.74514537774601, 4.645852612178535},
              t)),
          ToByte(Polynomial(
              {0.3340998053353061, 1.384590162594685, 0.09509516302823659, -19.33244095627987,
               56.69055260068105, -65.35303263337234, 26.3124352495832},
              t))};
}

std::array<Rgb, 256> MakePalette(Rgb (*color_of)(double)) {
  std::array<Rgb, 256> palette;
  for (size_t k = 0; k < palette.size(); ++k) palette[k] = color_of(static_cast<double>(k) / 255);
  return palette;
}

// Colours each pixel by nearness(x, y): 0 farthest .. 1 nearest, NaN invalid.
template <class Nearness>
ColorImage Colorize(int width, int height, ColorMap map, BufferPool& pool, Nearness nearness) {
  const std::array<Rgb, 256>& palette = Palette(map);
  const Rgb invalid = InvalidColor(map);
  ColorImage image(pool, width, height);
  for (int y = 0; y < height; ++y) {
    Rgb* row = image.Row(y);
    for (int x = 0; x < width; ++x) {
      const float t = nearness(x, y);
      row[x] = std::isnan(t) ? invalid
                             : palette[static_cast<size_t>(std::clamp(t, 0.0F, 1.0F) * 255 + 0.5F)];
    }
  }
  return image;
}

}  // namespace

const std::array<Rgb, 256>& Palette(ColorMap map) {
  static const std::array<std::array<Rgb, 256>, 4> kPalettes = {
      MakePalette(Grey), MakePalette(Hue), MakePalette(Turbo), MakePalette(Viridis)};
  return kPalettes[static_cast<size_t>(map)];
}

Rgb InvalidColor(ColorMap map) { return map == ColorMap::kHue ? Rgb{255, 0, 0} : Rgb{0, 0, 0}; }

ColorImage ColorizeDisparity(const DisparityMap& map, ColorMap color_map, double far_px,
                             double near_px, BufferPool& pool) {
  const auto scale = static_cast<float>(1 / (kDisparityScale * (near_px - far_px)));
  const auto zero = static_cast<float>(kDisparityScale * (far_px - map.offset_px));
  return Colorize(
      map.disparity.width(), map.disparity.height(), color_map, pool, [&](int x, int y) {
        const uint16_t stored = map.disparity.Row(y)[x];
        return stored == kInvalidDisparity ? NAN : (static_cast<float>(stored) - zero) * scale;
      });
}

ColorImage ColorizeDepth(const DepthMap& map, ColorMap color_map, double near_m, double far_m,
                         BufferPool& pool) {
  const auto scale = static_cast<float>(1 / (far_m - near_m));
  const auto far = static_cast<float>(far_m);
  return Colorize(map.depth_m.width(), map.depth_m.height(), color_map, pool,
                  [&](int x, int y) { return (far - map.depth_m.Row(y)[x]) * scale; });
}

}  // namespace vs
