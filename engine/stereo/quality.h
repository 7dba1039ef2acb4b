#pragma once

#include <array>
#include <cstdint>

#include "engine/base/status.h"
#include "engine/image/depth_map.h"
#include "engine/image/disparity_map.h"
#include "engine/image/frame.h"

namespace vs {

// A rectangle of pixels; what lies outside the picture is left out.
struct PixelRect {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;

  bool operator==(const PixelRect&) const = default;
};

// Share of pixels that have a disparity, 0..100 %; 0 for an empty region.
double ValidPercent(const DisparityMap& map, const PixelRect& region);

// How flat a region is.
struct PlaneFit {
  double rms_m = 0;         // of the distances from the plane, without outliers
  double distance_m = 0;    // from the left camera to the plane
  double tilt_deg = 0;      // between the plane's normal and the optical axis, 0..90
  double used_percent = 0;  // of the region's valid pixels; the others are outliers
  int64_t pixels = 0;       // used
};

// Fits a plane to a region by least squares of 1 / depth, in which stereo's noise is even, leaving
// out pixels farther off than three robust standard deviations (from the median deviation), in a
// few rounds. FAILED_PRECONDITION when the focal length is not known, or the region has fewer than
// 16 valid pixels or they do not span a plane.
Result<PlaneFit> FitPlane(const DepthMap& map, const PixelRect& region);

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
