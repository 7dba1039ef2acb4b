// Turns disparity into metres.
#include <utility>

#include "engine/core/block.h"
#include "engine/stereo/depth.h"

namespace vs {
namespace {

class DisparityToDepth final : public Block {
 public:
  In<DisparityMap> disparity{this, "disparity", "Disparity of a rectified pair."};
  Out<DepthMap> depth{this, "depth",
                      "Distance of each pixel along the camera's axis; unknown where there is no "
                      "disparity."};

  Status Run() override {
    VS_ASSIGN_OR_RETURN(DepthMap map, DepthFromDisparity(*disparity, pool()));
    depth.Set(std::move(map));
    return {};
  }
};

VS_REGISTER_BLOCK(DisparityToDepth,
                  {.category = "Stereo",
                   .doc = "Computes the distance of each pixel in metres from its disparity and "
                          "the geometry of the cameras."});

}  // namespace
}  // namespace vs
