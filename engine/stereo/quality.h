#pragma once

#include <cstdint>

#include "engine/base/status.h"
#include "engine/image/disparity_map.h"
#include "engine/image/frame.h"
#include "engine/image/pixel_rect.h"

namespace vs {

// Share of pixels that have a disparity, 0..100 %; 0 for an empty region.
double ValidPercent(const DisparityMap& map, const PixelRect& region);

// A disparity map against the truth. The measures are Middlebury's (Scharstein, Szeliski 2002),
// over the pixels that both cameras see and whose truth is known.
struct TruthScore {
  int64_t pixels = 0;             // evaluated
  double valid_percent = 0;       // of these, those with a disparity ("density")
  double bad1_percent = 0;        // invalid, or off by more than 1 px
  double bad2_percent = 0;        // invalid, or off by more than 2 px
  double valid_bad1_percent = 0;  // of the valid ones, those off by more than 1 px
  double valid_bad2_percent = 0;  // of the valid ones, those off by more than 2 px
  double average_error_px = 0;    // mean |error| of the valid ones
  double mean_error_px = 0;       // mean signed error of the valid ones within 1 px
  double depth_bias_percent = 0;  // mean of (depth / true depth - 1) over the same
};

// INVALID_ARGUMENT when the truth has another size than the map.
Result<TruthScore> ScoreAgainstTruth(const DisparityMap& map, const StereoTruth& truth,
                                     const PixelRect& region);

}  // namespace vs
