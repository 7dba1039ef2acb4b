// Turns depth into points in space.
#include <utility>

#include "engine/core/block.h"
#include "engine/stereo/depth.h"

namespace vs {
namespace {

class DepthToPoints final : public Block {
 public:
  In<DepthMap> depth{this, "depth", "Distance of each pixel along the camera's axis."};
  Out<PointCloud> points{this, "points",
                         "The point in space that each pixel shows, in metres from the left "
                         "camera: x to the right, y down, z away from it."};

  Status Run() override {
    VS_ASSIGN_OR_RETURN(PointCloud cloud, PointsFromDepth(*depth, pool()));
    points.Set(std::move(cloud));
    return {};
  }
};

VS_REGISTER_BLOCK(DepthToPoints, {.category = "Stereo",
                                  .doc = "Computes the point in space that each pixel of a depth "
                                         "map shows. SaveImages writes them as a PLY file; clients "
                                         "are sent depth, not points."});

}  // namespace
}  // namespace vs
