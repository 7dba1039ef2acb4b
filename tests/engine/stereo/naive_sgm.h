#pragma once

#include "engine/image/buffer.h"
#include "engine/image/disparity_map.h"
#include "engine/image/image.h"
#include "engine/stereo/sgm_settings.h"

namespace vs {

// Semi-global matching written down once more from the definitions, pixel by pixel in plain
// integers, without any of the product's stages and without regard to time: what matchers are
// compared with on small pictures. The settings must be valid.
DisparityMap NaiveSgm(const GreyImage& left, const GreyImage& right, const SgmSettings& settings,
                      BufferPool& pool);

}  // namespace vs
