#pragma once

#include "engine/base/status.h"
#include "engine/image/pixel_rect.h"
#include "engine/stereo/stereo_matcher.h"

namespace vs {

// The disparities of the right view's own pixels, right(x, y) = left(x + right(x, y), y): the pair
// is matched mirrored and with the views exchanged, and the answer mirrored back. For a left-right
// check of two full matches (Woodward et al. 2010) with CheckLeftRight. Arguments and errors as
// MatchRegion; the region is one of the right picture.
Result<DisparityMap> MatchRightView(StereoMatcher& matcher, const GreyImage& left,
                                    const GreyImage& right, const PixelRect& region,
                                    const SgmSettings& settings, int threads, BufferPool& pool);

}  // namespace vs
