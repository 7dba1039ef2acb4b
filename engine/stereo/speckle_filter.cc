#include "engine/stereo/speckle_filter.h"

#include <cstdint>
#include <cstdlib>

#include "engine/image/image.h"

namespace vs {
namespace {

// Regions as trees of pixels (union-find): each pixel names another of its region, the root names
// itself. The smaller index becomes the root, so that a pixel never names a later one.
class Regions {
 public:
  explicit Regions(Image<int32_t>* parents) : parents_(parents->Row(0)) {}

  void Add(int32_t pixel) { parents_[pixel] = pixel; }
  int32_t Root(int32_t pixel) {
    while (parents_[pixel] != pixel) {
      parents_[pixel] = parents_[parents_[pixel]];
      pixel = parents_[pixel];
    }
    return pixel;
  }
  void Join(int32_t a, int32_t b) {
    a = Root(a);
    b = Root(b);
    if (a < b) {
      parents_[b] = a;
    } else {
      parents_[a] = b;
    }
  }

 private:
  int32_t* parents_;
};

}  // namespace

void RemoveSpeckles(int max_size, int max_step, BufferPool& pool, DisparityMap* map) {
  const int width = map->disparity.width();
  const int height = map->disparity.height();
  Image<int32_t> parents(pool, width, height);
  Image<int32_t> sizes(pool, width, height);
  sizes.Fill(0);
  Regions regions(&parents);
  for (int y = 0; y < height; ++y) {
    const uint16_t* row = map->disparity.Row(y);
    const uint16_t* above = y > 0 ? map->disparity.Row(y - 1) : nullptr;
    for (int x = 0; x < width; ++x) {
      if (row[x] == kInvalidDisparity) continue;
      const int32_t pixel = y * width + x;
      const auto connected = [&](uint16_t other) {
        return other != kInvalidDisparity && std::abs(other - row[x]) <= max_step;
      };
      regions.Add(pixel);
      if (x > 0 && connected(row[x - 1])) regions.Join(pixel, pixel - 1);
      if (above != nullptr && connected(above[x])) regions.Join(pixel, pixel - width);
    }
  }
  int32_t* size_of = sizes.Row(0);
  const auto for_each_valid = [&](auto visit) {
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        if (map->disparity.Row(y)[x] != kInvalidDisparity) visit(x, y, regions.Root(y * width + x));
      }
    }
  };
  for_each_valid([&](int, int, int32_t root) { ++size_of[root]; });
  for_each_valid([&](int x, int y, int32_t root) {
    if (size_of[root] > max_size) return;
    map->disparity.Row(y)[x] = kInvalidDisparity;
    map->confidence.Row(y)[x] = 0;
    map->reason.Row(y)[x] = static_cast<uint8_t>(InvalidReason::kSpeckle);
  });
}

}  // namespace vs
