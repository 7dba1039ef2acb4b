#include "engine/stereo/color_map.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace vs {
namespace {

uint8_t ToByte(double value) {
  return static_cast<uint8_t>(std::lround(255 * std::clamp(value, 0.0, 1.0)));
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

// Every 15th of a published table's 256 colours; straight lines between them stay within 6 levels.
using Samples = std::array<Rgb, 18>;

// A. Mikhailov, "Turbo, An Improved Rainbow Colormap for Visualization", Google, 2019 (Apache 2.0).
constexpr Samples kTurboSamples = {{{48, 18, 59},
                                    {63, 62, 156},
                                    {70, 102, 221},
                                    {69, 140, 253},
                                    {47, 178, 244},
                                    {26, 212, 208},
                                    {34, 235, 170},
                                    {82, 250, 122},
                                    {139, 255, 75},
                                    {183, 247, 53},
                                    {219, 226, 54},
                                    {245, 197, 58},
                                    {254, 161, 48},
                                    {249, 117, 29},
                                    {232, 75, 12},
                                    {206, 45, 4},
                                    {169, 22, 1},
                                    {122, 4, 3}}};

// S. van der Walt and N. Smith, matplotlib's "viridis", 2015 (CC0).
constexpr Samples kViridisSamples = {{{68, 1, 84},
                                      {72, 23, 105},
                                      {71, 42, 122},
                                      {67, 61, 132},
                                      {61, 78, 138},
                                      {53, 94, 141},
                                      {46, 109, 142},
                                      {41, 123, 142},
                                      {35, 137, 142},
                                      {31, 151, 139},
                                      {33, 165, 133},
                                      {46, 179, 124},
                                      {70, 192, 111},
                                      {101, 203, 94},
                                      {137, 213, 72},
                                      {176, 221, 47},
                                      {216, 226, 25},
                                      {253, 231, 37}}};

Rgb Between(const Samples& samples, double t) {
  const double place = t * (samples.size() - 1);
  const size_t first = std::min(static_cast<size_t>(place), samples.size() - 2);
  const double part = place - static_cast<double>(first);
  const auto mix = [&](uint8_t a, uint8_t b) { return ToByte((a + part * (b - a)) / 255); };
  const Rgb& a = samples[first];
  const Rgb& b = samples[first + 1];
  return {mix(a.r, b.r), mix(a.g, b.g), mix(a.b, b.b)};
}

Rgb Turbo(double t) { return Between(kTurboSamples, t); }
Rgb Viridis(double t) { return Between(kViridisSamples, t); }

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
      if (std::isnan(t)) {
        row[x] = invalid;
        continue;
      }
      // 255 t, rounded
      const auto half_steps = static_cast<size_t>(std::clamp(t, 0.0F, 1.0F) * 510);
      row[x] = palette[(half_steps + 1) / 2];
    }
  }
  return image;
}

}  // namespace

const std::array<Rgb, 256>& Palette(ColorMap map) {
  static const std::array<std::array<Rgb, 256>, 4> palettes = {
      MakePalette(Grey), MakePalette(Hue), MakePalette(Turbo), MakePalette(Viridis)};
  return palettes[static_cast<size_t>(map)];
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
