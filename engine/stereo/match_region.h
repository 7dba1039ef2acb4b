#pragma once

#include "engine/base/status.h"
#include "engine/image/pixel_rect.h"
#include "engine/stereo/stereo_matcher.h"

namespace vs {

// Matches only what it takes to know the disparities in `region`, a part of the left picture: the
// region with kRegionContext px around it, from where paths and filters reach into it, and the
// columns of the right picture where its counterparts may be. The map has the size of the picture;
// outside the region it is invalid for InvalidReason::kMasked. A region of the whole picture is
// what StereoMatcher::Match does. INVALID_ARGUMENT when the region is outside the picture, and as
// Match.
Result<DisparityMap> MatchRegion(StereoMatcher& matcher, const GreyImage& left,
                                 const GreyImage& right, const PixelRect& region,
                                 const SgmSettings& settings, int threads, BufferPool& pool);

inline constexpr int kRegionContext = 32;

}  // namespace vs
