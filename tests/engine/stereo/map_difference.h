#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>

#include "engine/base/str.h"
#include "engine/image/depth_map.h"
#include "engine/image/disparity_map.h"
#include "engine/stereo/stereo_plan.h"

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

// The first pixel in which two maps differ in any bit, in words; empty if they are equal.
inline std::string DepthDifference(const DepthMap& a, const DepthMap& b) {
  if (!a.depth_m.SameSizeAs(b.depth_m) || !(a.geometry == b.geometry)) return "size or geometry";
  for (int y = 0; y < a.depth_m.height(); ++y) {
    for (int x = 0; x < a.depth_m.width(); ++x) {
      const float one = a.depth_m.Row(y)[x];
      const float other = b.depth_m.Row(y)[x];
      if (std::bit_cast<uint32_t>(one) == std::bit_cast<uint32_t>(other)) continue;
      return Str("(", x, ", ", y, "): ", one, " against ", other, " m");
    }
  }
  return "";
}

// What two results differ in, in words; empty if they are equal in every bit.
inline std::string ResultDifference(const StereoResult& a, const StereoResult& b) {
  if (!a.left.SameSizeAs(b.left)) return "size of the left picture";
  for (int y = 0; y < a.left.height(); ++y) {
    if (std::memcmp(a.left.Row(y), b.left.Row(y), static_cast<size_t>(a.left.width())) != 0) {
      return Str("row ", y, " of the left picture");
    }
  }
  if (!(a.disparity.geometry == b.disparity.geometry)) return "geometry";
  const std::string maps = MapDifference(a.disparity, b.disparity);
  return maps.empty() ? DepthDifference(a.depth, b.depth) : maps;
}

}  // namespace vs
