#pragma once

#include "engine/image/buffer.h"
#include "engine/image/image.h"
#include "engine/image/rectified_geometry.h"
#include "engine/image/remap.h"

namespace vs {

// How the two pictures of a pair of cameras become those of an ideal pair. Rectifier
// (engine/calibration) makes it of a rig.
struct Rectification {
  int raw_width = 0;  // px, of the pictures as they are taken
  int raw_height = 0;
  bool half_size = false;  // they are Halved() first
  Interpolation interpolation = Interpolation::kLinear;
  // Of the size that `geometry` has; they look into the raw or halved picture.
  RemapTable left;
  RemapTable right;
  RectifiedGeometry geometry;
};

// The ideal picture of the view that has `table`, one of both; `raw` has the raw size. Pixels that
// the camera did not see are 0.
GreyImage Rectified(const GreyImage& raw, const Rectification& rectification,
                    const RemapTable& table, BufferPool& pool);

}  // namespace vs
