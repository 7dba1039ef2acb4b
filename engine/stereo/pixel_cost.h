#pragma once

#include <cstdint>
#include <vector>

#include "engine/stereo/padded_picture.h"
#include "engine/stereo/sgm_settings.h"

namespace vs {

// How unlike two pixels are: C(x, y, i) compares left pixel (x, y) with right pixel (x - d, y),
// d = min_disparity + i. With I the picture of PaddedPicture (greys or gradients):
//
//   kSad               min(|I_L - I_R|, grey_limit)
//   kBirchfieldTomasi  min(a, b, grey_limit), a = max(0, I_L - hi_R, lo_R - I_L) and b the same
//                      with the views exchanged; lo and hi are the least and greatest of I(x) and
//                      its half-way values (I(x) + I(x-1) + 1) >> 1, (I(x) + I(x+1) + 1) >> 1
//   kCensus            Hamming distance of the census codes, halved with (n + 1) >> 1 for 7x7, 9x7
//   kAdCensus          the same plus min(|J_L - J_R|, ad_limit) with J = (I + 2) >> 2
//
// Where x - d lies outside the picture the cost is OutsideCost(settings).

// The effective SgmSettings::outside_cost. A low one makes the border columns flee out of the
// picture, a high one bends depth edges; about 0.3 of the largest cost suits the census costs.
int OutsideCost(const SgmSettings& settings);

// What a row of pixels is compared by, in planes of one byte a pixel: the census code (its bytes),
// then J for kAdCensus; I for kSad; I, lo and hi for kBirchfieldTomasi.
int FeaturePlanes(const SgmSettings& settings);
// Plane p of pixel x of row `y` goes to planes[p * width + x].
void FeatureRow(const PaddedPicture& picture, const SgmSettings& settings, int y, uint8_t* planes);

// J of a row.
void CoarseGreyRow(const PaddedPicture& picture, int y, uint8_t* out);

// The indices i whose counterpart of left pixel x lies inside the right picture: [begin, end).
struct InsideRange {
  int begin;
  int end;
};
InsideRange InsideOf(int x, int width, const SgmSettings& settings);

// Computes cost rows, one at a time. Keeps scratch memory; one per thread.
class PixelCost {
 public:
  // The pictures must stay alive and have the same size; the settings must be valid.
  void Prepare(const PaddedPicture* left, const PaddedPicture* right, const SgmSettings& settings);
  // C(x, y, i) goes to cost[x * num_disparities + i].
  void Row(int y, uint8_t* cost);

 private:
  void Compare(int x, int begin, int end, int mirrored, uint8_t* cost) const;

  const PaddedPicture* left_picture_ = nullptr;
  const PaddedPicture* right_picture_ = nullptr;
  SgmSettings settings_;
  int width_ = 0;
  int planes_ = 0;
  std::vector<uint8_t> left_;
  // Mirrored (pixel x at width - 1 - x), so that both the index i and the address grow together.
  std::vector<uint8_t> right_;
};

}  // namespace vs
