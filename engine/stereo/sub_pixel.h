#pragma once

#include <algorithm>

#include "engine/stereo/quick_division.h"
#include "engine/stereo/sgm_settings.h"

namespace vs {

// Where the minimum lies relative to the winner, in 1/16 px, -8..8. `best` is the least cost,
// `before` and `after` those of the neighbouring disparities. With n = 8 * (before - after),
// rounded to the nearest integer, halves upwards:
//   kEquiangular  n / (max(before, after) - best)
//   kParabola     n / (before + after - 2 * best)
// and 0 where the divisor is 0.
inline int SubPixelSixteenths(SubPixel method, int before, int best, int after) {
  if (method == SubPixel::kOff) return 0;
  const int divisor =
      method == SubPixel::kEquiangular ? std::max(before, after) - best : before + after - 2 * best;
  if (divisor <= 0) return 0;
  // floor((2 n + divisor) / (2 divisor)), made positive for the integer division: n >= -8 divisor.
  const int numerator = 16 * (before - after) + divisor + 16 * divisor;
  return QuickDivide(numerator, 2 * divisor) - 8;
}

}  // namespace vs
