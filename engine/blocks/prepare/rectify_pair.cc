// Undoes lens distortion and misalignment of a pair of cameras by their calibration.
#include <utility>

#include "engine/blocks/prepare/rectify_params.h"
#include "engine/core/block.h"

namespace vs {
namespace {

class RectifyPair final : public Block {
 public:
  In<StereoFrame> pair{this, "pair", "The pair as the cameras took it."};
  Out<StereoFrame> rectified{this, "rectified",
                             "The pair as two ideal, parallel cameras would see it: a point lies "
                             "in the same row of both pictures."};
  RectifyParams rectify{this};

  Status Start() override { return rectify.Start(environment()); }

  Status Run() override {
    if (pair->geometry) {
      return FailedPrecondition("this pair is rectified already; remove this block");
    }
    if (pair->left == nullptr) return InvalidArgument("the pair has no left picture");
    VS_ASSIGN_OR_RETURN(const Rectifier* rectifier,
                        rectify.For(pair->left->image.width(), pair->left->image.height()));
    VS_ASSIGN_OR_RETURN(StereoFrame result, rectifier->Rectify(*pair, pool()));
    rectified.Set(std::move(result));
    return {};
  }
};

VS_REGISTER_BLOCK(
    RectifyPair,
    {.category = "Prepare",
     .doc = "Removes lens distortion and turns both views parallel, by the cameras' "
            "calibration. Matching needs such a pair. Takes pictures of the calibrated "
            "size or binned ones; a window of the sensor needs its own calibration."});

}  // namespace
}  // namespace vs
