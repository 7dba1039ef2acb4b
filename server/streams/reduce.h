#pragma once

#include <cstdint>

#include "engine/image/buffer.h"
#include "engine/image/image.h"

namespace vs {

// Images made smaller by a whole number: pixel (x, y) of the result stands for the step x step
// pixels of the original that begin at (x * step, y * step); at the right and lower edge for fewer.

// The smallest step with which an image of this width becomes at most `max_width_px` wide; 1 when
// that is 0.
int ReducingStep(int width, uint32_t max_width_px);

// That one pixel, unchanged: for maps, where a mean of near and far would be neither. O(result).
template <class Pixel>
Image<Pixel> Nearest(const Image<Pixel>& image, int step, BufferPool& pool);

// The mean of those pixels, rounded: for pictures, which would flicker otherwise. O(original).
GreyImage Mean(const GreyImage& image, int step, BufferPool& pool);
ColorImage Mean(const ColorImage& image, int step, BufferPool& pool);

}  // namespace vs
