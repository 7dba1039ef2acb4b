#pragma once

#include <array>
#include <string>

#include "engine/base/str.h"
#include "engine/image/disparity_map.h"

namespace vs {

// The first pixel in which two maps differ, in words; empty if they are equal.
inline std::string MapDifference(const DisparityMap& a, const DisparityMap& b) {
  if (!a.disparity.SameSizeAs(b.disparity) || a.offset_px != b.offset_px) return "size or offset";
  for (int y = 0; y < a.disparity.height(); ++y) {
    for (int x = 0; x < a.disparity.width(); ++x) {
      const std::array<int, 3> left = {a.disparity.Row(y)[x], a.confidence.Row(y)[x],
                                       a.reason.Row(y)[x]};
      const std::array<int, 3> right = {b.disparity.Row(y)[x], b.confidence.Row(y)[x],
                                        b.reason.Row(y)[x]};
      if (left == right) continue;
      return Str("(", x, ", ", y, "): disparity, confidence, reason ", left[0], " ", left[1], " ",
                 left[2], " against ", right[0], " ", right[1], " ", right[2]);
    }
  }
  return "";
}

}  // namespace vs
