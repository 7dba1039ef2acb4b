#pragma once

#include <cstdint>
#include <string_view>

#include "engine/image/image.h"
#include "engine/image/rectified_geometry.h"

namespace vs {

// Disparities are stored in sixteenths of a pixel.
inline constexpr int kDisparityScale = 16;
// The stored value of a pixel without a disparity.
inline constexpr uint16_t kInvalidDisparity = 0;

// Why a pixel has no disparity. Numbers are part of the API: never reused.
enum class InvalidReason : uint8_t {
  kNone = 0,        // the pixel is valid
  kOccluded = 1,    // seen by one camera only: the views disagree
  kLowTexture = 2,  // too little structure to match
  kAmbiguous = 3,   // several disparities fit equally well
  kOutOfRangeNear = 4,
  kOutOfRangeFar = 5,
  kSaturated = 6,  // overexposed
  kDark = 7,       // underexposed
  kBorder = 8,     // its counterpart would lie outside the right image
  kSpeckle = 9,    // part of a region too small to be trusted
  kMasked = 10,    // excluded by a mask or region of interest
  kFiltered = 11,  // removed by a filter
};
inline constexpr int kInvalidReasonCount = 12;

// "occluded", "low texture" ... in words for people.
std::string_view InvalidReasonName(InvalidReason reason);

// Disparity of the left view: pixel (x, y) matches (x - disparity, y) of the right view, with
//   disparity_px = stored / 16.0 + offset_px.
// The three images have the same size. `offset_px` is 0 unless the search range is negative, so a
// stored 0 always means "invalid" (a disparity of exactly 0 is infinitely far and counts as such).
struct DisparityMap {
  Image<uint16_t> disparity;  // 1/16 px above offset_px; kInvalidDisparity where there is none
  GreyImage confidence;       // 0 (none, and wherever invalid) .. 255
  GreyImage reason;           // InvalidReason; kNone exactly where the disparity is valid
  int offset_px = 0;
  RectifiedGeometry geometry;
};

}  // namespace vs
