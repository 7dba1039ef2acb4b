#pragma once

#include <cstdint>

#include "engine/base/status.h"
#include "engine/image/buffer.h"
#include "engine/image/depth_map.h"
#include "engine/image/pixel_rect.h"

namespace vs {

// How flat a region is.
struct PlaneFit {
  double rms_m = 0;         // of the distances from the plane, without outliers
  double distance_m = 0;    // from the left camera to the plane
  double tilt_deg = 0;      // between the plane's normal and the optical axis, 0..90
  double used_percent = 0;  // of the region's valid pixels; the others are outliers
  int64_t pixels = 0;       // used, of those that were looked at
};

// Fits a plane to a region by least squares of 1 / depth, in which stereo's noise is even, leaving
// out pixels farther off than three robust standard deviations (from the median deviation), in a
// few rounds. Of a region of more than 40000 pixels every second row and column is looked at, or
// every third and so on, so that it takes a few milliseconds at most. FAILED_PRECONDITION when the
// focal length is not known, or the region has fewer than 16 valid pixels or they do not span a
// plane. `pool` serves scratch memory only.
Result<PlaneFit> FitPlane(const DepthMap& map, const PixelRect& region, BufferPool& pool);

}  // namespace vs
