#include "engine/stereo/background_fill.h"

#include <algorithm>

#include "engine/stereo/selection.h"

namespace vs {

void FillBackgroundRows(int begin, int end, DisparityMap* map) {
  const int width = map->disparity.width();
  for (int y = begin; y < end; ++y) {
    uint16_t* row = map->disparity.Row(y);
    for (int x = 0; x < width;) {
      if (row[x] != kInvalidDisparity) {
        ++x;
        continue;
      }
      const int first = x;
      while (x < width && row[x] == kInvalidDisparity) ++x;
      const uint16_t left = first > 0 ? row[first - 1] : kInvalidDisparity;
      const uint16_t right = x < width ? row[x] : kInvalidDisparity;
      const bool both = left != kInvalidDisparity && right != kInvalidDisparity;
      const uint16_t fill = both ? std::min(left, right) : std::max(left, right);
      if (fill == kInvalidDisparity) continue;
      std::fill(row + first, row + x, fill);
      std::fill(map->confidence.Row(y) + first, map->confidence.Row(y) + x, kFilledConfidence);
      std::fill(map->reason.Row(y) + first, map->reason.Row(y) + x,
                static_cast<uint8_t>(InvalidReason::kNone));
    }
  }
}

}  // namespace vs
