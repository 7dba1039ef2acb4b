// Removes small patches that differ from what surrounds them.
#include "engine/stereo/speckle_filter.h"

#include <cmath>
#include <cstring>
#include <utility>

#include "engine/core/block.h"

namespace vs {
namespace {

template <class T>
Image<T> Copy(const Image<T>& image, BufferPool& pool) {
  Image<T> copy(pool, image.width(), image.height());
  for (int y = 0; y < image.height(); ++y) {
    std::memcpy(copy.Row(y), image.Row(y), static_cast<size_t>(image.width()) * sizeof(T));
  }
  return copy;
}

class SpeckleFilter final : public Block {
 public:
  In<DisparityMap> disparity{this, "disparity", "Any disparity map."};
  Out<DisparityMap> filtered{this, "filtered", "The same map without small patches."};
  Param<int> max_size{this,
                      "max_size",
                      {.initial = 100,
                       .min = 0,
                       .max = 1000000,
                       .unit = "px",
                       .operator_editable = true,
                       .doc = "Patches of up to this many pixels become invalid."}};
  Param<double> max_step{this,
                         "max_step",
                         {.initial = 1,
                          .min = 0.0625,
                          .max = 16.0,
                          .unit = "px",
                          .doc = "Neighbours whose disparities differ by more belong to different "
                                 "patches."}};

  Status Run() override {
    DisparityMap map{.disparity = Copy(disparity->disparity, pool()),
                     .confidence = Copy(disparity->confidence, pool()),
                     .reason = Copy(disparity->reason, pool()),
                     .offset_px = disparity->offset_px,
                     .geometry = disparity->geometry};
    const auto step = static_cast<int>(std::lround(*max_step * kDisparityScale));
    RemoveSpeckles(*max_size, step, pool(), &map);
    filtered.Set(std::move(map));
    return {};
  }
};

VS_REGISTER_BLOCK(SpeckleFilter,
                  {.category = "Stereo",
                   .doc = "Removes small isolated patches of disparity, which are mostly wrong."});

}  // namespace
}  // namespace vs
