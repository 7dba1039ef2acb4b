#pragma once

#include <algorithm>
#include <cstdint>

namespace vs {

// A rectangle of pixels; what lies outside the picture is left out.
struct PixelRect {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;

  bool operator==(const PixelRect&) const = default;
};

// The part of `region` inside a picture; it may be empty.
inline PixelRect Inside(const PixelRect& region, int width, int height) {
  const auto clip = [](int64_t value, int limit) {
    return static_cast<int>(std::clamp<int64_t>(value, 0, limit));
  };
  const int x = clip(region.x, width);
  const int y = clip(region.y, height);
  return {x, y, clip(int64_t{region.x} + region.width, width) - x,
          clip(int64_t{region.y} + region.height, height) - y};
}

}  // namespace vs
