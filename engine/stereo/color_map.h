#pragma once

#include <array>
#include <cstdint>

#include "engine/image/buffer.h"
#include "engine/image/depth_map.h"
#include "engine/image/disparity_map.h"
#include "engine/image/image.h"

namespace vs {

// How nearness becomes colour. The first two are those of Woodward et al. 2010.
enum class ColorMap : uint8_t {
  kGrey,     // near is light; invalid black
  kHue,      // hue proportional to disparity, full saturation and value; invalid red (hue 0)
  kTurbo,    // near is red; invalid black (Mikhailov 2019)
  kViridis,  // near is yellow; even in brightness and for the colour-blind; invalid black
};

// What the 256 steps from farthest (0) to nearest (255) look like.
const std::array<Rgb, 256>& Palette(ColorMap map);
Rgb InvalidColor(ColorMap map);

// Colours a disparity map: `far_px` and less gives the palette's first colour, `near_px` and more
// its last, in proportion between them. far_px < near_px.
ColorImage ColorizeDisparity(const DisparityMap& map, ColorMap color_map, double far_px,
                             double near_px, BufferPool& pool);

// Colours a depth map: `far_m` and more gives the palette's first colour, `near_m` and less its
// last, in proportion to depth between them. near_m < far_m.
ColorImage ColorizeDepth(const DepthMap& map, ColorMap color_map, double near_m, double far_m,
                         BufferPool& pool);

}  // namespace vs
