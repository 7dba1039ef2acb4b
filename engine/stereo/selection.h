#pragma once

#include <cstdint>
#include <vector>

#include "engine/image/disparity_map.h"
#include "engine/image/image.h"
#include "engine/stereo/filter_kernels.h"
#include "engine/stereo/path_cost.h"
#include "engine/stereo/sgm_settings.h"
#include "engine/stereo/winner_row.h"

namespace vs {

// From summed path costs S to disparities, row by row.
//
// Left view: pixel x takes the index i of least S(x, i). Right view: pixel x takes the index of
// least S(x + d, i), d = min_disparity + i, over those that lie inside the left picture; 0 if none
// of them is below 255. Ties go to the smaller disparity.
//
// Let Z = S(x, i) be a left pixel's least sum, N the least S(x, k) over |k - i| > 1 (255 if there
// is no such k), and V the views' difference: |right(x - d) - i|, or if left_right_lenient the
// smaller of this and |right(x - d - 1) - i| (where that is inside); 0 without left_right_check.
// The pixel becomes invalid by the first of these that holds:
//   1. its counterpart x - d lies outside the right picture   kBorder
//   2. the stored disparity (below) is not positive           kOutOfRangeFar
//   3. V > left_right_tolerance                               kOutOfRangeFar if i is the first
//   index,
//                                  kOutOfRangeNear if the last, else Explain(kOccluded)
//   4. N * (100 - uniqueness_percent) < Z * 100               Explain(kAmbiguous)
//   5. confidence < min_confidence                            kFiltered
// Explain(reason) is, by the first that holds: kSaturated where the left grey is >= 254, kDark
// where it is <= 3, kLowTexture where the greys within 2 px (inside the picture) span less than 8
// levels, else `reason`.
//
// Stored disparity: 16 * (d - offset_px) + sub-pixel sixteenths, the latter 0 where i is the first
// or last index. offset_px is 0, or min_disparity - 1 if that is negative. The sixteenths say where
// the minimum lies between the winner's neighbours: with n = 8 * (S(x, i - 1) - S(x, i + 1)),
// rounded to the nearest integer, halves upwards, -8..8,
//   kEquiangular  n / (max(S(x, i - 1), S(x, i + 1)) - Z)
//   kParabola     n / (S(x, i - 1) + S(x, i + 1) - 2 Z)
// and 0 where the divisor is 0.
//
// Confidence: 255 * (N - Z) / N in integers (0 if N is 0), shifted right by V, but at least 2: 0
// means invalid and 1 means that a filter has put the value there (kFilledConfidence).

// The map's offset_px for these settings.
int DisparityOffset(const SgmSettings& settings);

// Confidence of a pixel whose disparity was filled in, not measured.
inline constexpr uint8_t kFilledConfidence = 1;
inline constexpr uint8_t kLeastConfidence = 2;

// From winners to disparities: writes row `y` of the three images of `map`. `right_index` is the
// right view's row of winners; not looked at without left_right_check.
void JudgeRow(const SgmSettings& settings, const GreyImage& left, int y, const WinnerRow& winners,
              const uint8_t* right_index, const FilterKernels& kernels, DisparityMap* map);

// Selects the disparities of single rows. Keeps scratch memory; one per thread.
class Selection {
 public:
  void Prepare(const SgmSettings& settings, int width);
  // Writes row `y` of the three images of `map`, which have the size of `sums`.
  void Row(const CellVolume& sums, const GreyImage& left, int y, DisparityMap* map);

 private:
  void SelectRight(const CellVolume& sums, int y);
  void SelectLeft(const CellVolume& sums, int y);

  SgmSettings settings_;
  int width_ = 0;
  std::vector<uint8_t> indices_;      // 0, 1, 2 ... 255
  std::vector<uint8_t> right_least_;  // mirrored: right pixel x at width - 1 - x
  std::vector<uint8_t> right_index_;  // by right pixel
  std::vector<uint8_t> winner_memory_;
  WinnerRow winners_;
};

}  // namespace vs
