#pragma once

#include "engine/image/buffer.h"
#include "engine/image/image.h"

namespace vs {

// The same picture at width x height px, at least 1 x 1. Along an axis that shrinks, a pixel is the
// mean of those that it covers, in proportion to how much of each it covers; along one that grows,
// it is interpolated linearly between the two nearest. All memory comes from `pool`: that is why
// this is not OpenCV's resize, which asks the heap for its tables at each picture.
//
// About width_in * height * s + width * height * s operations, s = the larger of 2 and the shrink
// factor.
GreyImage Resample(const GreyImage& image, int width, int height, BufferPool& pool);

// The same picture at half the size, each pixel the mean of 2 x 2, rounded to the nearest: what a
// camera's binning makes of it. An odd last row or column is left out. At least 2 x 2 px.
GreyImage Halved(const GreyImage& image, BufferPool& pool);

}  // namespace vs
