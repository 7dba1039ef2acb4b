#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/base/status.h"
#include "engine/image/image.h"

namespace vs {

// What a pixel of the left view is compared by.
enum class MatchCost : uint8_t {
  kBirchfieldTomasi,  // grey difference that forgives half a pixel of sampling (Birchfield, Tomasi
                      // 1998); with kSad and 7 directions, the cost of Woodward et al. 2010
  kSad,               // absolute grey difference
  kCensus,            // Hamming distance of census codes: immune to brightness
  kAdCensus,          // census plus a truncated grey difference: the most accurate
};

// The neighbours that a census code compares with the centre; one bit each.
enum class CensusPattern : uint8_t {
  k5x5,         // 24 bits
  k7x7,         // 48 bits, their distance halved
  k9x7,         // 9 wide, 7 high: 62 bits, their distance halved
  kStrided3x3,  // the 8 neighbours at distances 1, 2 and 3: 24 bits
};

// Where between two disparities the minimum lies.
enum class SubPixel : uint8_t {
  kOff,
  kParabola,     // through the three values around the minimum
  kEquiangular,  // two lines of opposite slope (Shimizu, Okutomi 2001)
};

// Smoothing of both pictures, against noise; it costs fine structure where there is none.
enum class PreBlur : uint8_t {
  kAutomatic,  // strong where the pictures are noisy, else off
  kOff,
  kLight,   // Gaussian of sigma 0.5 px
  kStrong,  // Gaussian of sigma 0.7 px
};

// The names that users write for the values of these, in the order of the values.
const std::vector<std::string>& ChoiceNames(MatchCost);
const std::vector<std::string>& ChoiceNames(CensusPattern);
const std::vector<std::string>& ChoiceNames(SubPixel);
const std::vector<std::string>& ChoiceNames(PreBlur);

// Everything that decides what a matcher computes. Two matchers given the same pictures and the
// same settings answer the same, bit for bit; how they get there is theirs. The initial values are
// the recommended ones ("quality").
//
// Costs, p1 and p2 share one unit: a census bit for the census costs, a grey level for
// kBirchfieldTomasi and kSad (the mean over the window, so that p1 and p2 keep their meaning when
// the window changes). Every cost is at most kMaxCost and p2 at most kMaxP2, so that a path cost
// never exceeds 127 and all arithmetic fits 8 bits.
//
// Penalties are those of one pixel, not of a window, and what exceeds the limits is refused, never
// rescaled: p1 and p2 compute what they say. OpenCV sums the cost over its M x N block instead, so
// its P1 = 8 * M * N and P2 = 32 * M * N are about p1 = 8 and p2 = 32 here, for every window:
// divide by the number of pixels (and of channels, where OpenCV counts them).
struct SgmSettings {
  // Search range: min_disparity .. min_disparity + num_disparities - 1 px. Pixel (x, y) of the left
  // view is compared with (x - disparity, y) of the right one.
  int min_disparity = 0;      // px, -2048..2048
  int num_disparities = 128;  // px, 1..256

  // The pictures, before anything else (condition_pair.h).
  PreBlur pre_blur = PreBlur::kAutomatic;
  bool match_gain = true;  // the right picture gets the left one's brightness and contrast

  // Cost (pixel_cost.h, census.h).
  MatchCost cost = MatchCost::kAdCensus;
  CensusPattern census = CensusPattern::kStrided3x3;
  int ad_limit = 4;     // kAdCensus: largest grey term, in units of 4 grey levels, 0..16
  int grey_limit = 63;  // kBirchfieldTomasi, kSad: differences count up to this, grey levels, 1..63
  int sobel_cap = 0;    // 1..127: compare horizontal gradients clipped to +-cap; 0: compare greys
  // Cost of a disparity whose counterpart lies outside the right picture, 0..63 cost units.
  // kAutomatic: what fits the cost, see OutsideCost().
  int outside_cost = kAutomatic;

  // Cost over a neighbourhood (cost_window.h).
  int window_width = 1;      // px, 1..15
  int window_height = 1;     // px, 1..15
  bool smooth_cost = true;   // binomial 3 x 3 that stops at edges
  int smooth_cost_gate = 6;  // grey levels, 0..255: a larger step is an edge

  // Paths (path_cost.h).
  int directions = 4;  // 1..8; 1: from the left, 2: + right, 4: + top, bottom, then diagonals
  int p1 = 7;          // cost units, 0..p2: penalty of a step by one disparity
  int p2 = 35;         // cost units, p1..64: penalty of any larger step
  int p2_min = 14;     // cost units, 0..64: p2 falls no lower at an edge
  int p2_slope_permille = 40;  // 0..1000: p2 / (1 + slope * grey step along the path); 0: constant

  // Selection (selection.h).
  SubPixel sub_pixel = SubPixel::kEquiangular;
  int uniqueness_percent = 0;  // 0..50: the best must be this much better than any other
  int min_confidence = 0;      // 0..255: less confident pixels become invalid

  // Left-right check (left_right_check.h).
  bool left_right_check = true;
  int left_right_tolerance = 1;    // px, 0..8 ("phi")
  bool left_right_lenient = true;  // the neighbour left of the counterpart may agree instead

  // Filters, in this order (median_filter.h, speckle_filter.h, gated_filter.h, background_fill.h).
  int median = 5;                // px, 0 (off), 3 or 5; closes 1-px holes
  int speckle_size = 60;         // px, 0 (off)..65535: regions up to this size are removed
  int speckle_step = 2;          // px, 1..16: neighbours that differ more belong to two regions
  bool gated_median = true;      // 5 x 5 median over the pixels of similar grey
  int gate = 20;                 // grey levels, 0..255: what "similar" means
  bool fill_holes = true;        // holes take the median of their similar neighbours if these agree
  bool fill_background = false;  // what is left takes the farther of its two neighbours in the row

  static constexpr int kAutomatic = -1;

  bool operator==(const SgmSettings&) const = default;
};

inline constexpr int kMaxCost = 63;
inline constexpr int kMaxP2 = 64;
// What a matcher accepts; width and height, px.
inline constexpr int kMinPictureSize = 16;
inline constexpr int kMaxPictureWidth = 4096;
inline constexpr int kMaxPictureHeight = 3072;

// INVALID_ARGUMENT with one fault for each field that is out of its range.
Status ValidateSettings(const SgmSettings& settings);
// INVALID_ARGUMENT unless pictures of this size can be matched.
Status ValidateSize(int width, int height);
// INVALID_ARGUMENT unless both pictures have the same size, within the limits above.
Status ValidatePair(const GreyImage& left, const GreyImage& right);

}  // namespace vs
