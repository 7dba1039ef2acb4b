// From a raw pair to disparity and depth in one step.
#include <memory>
#include <utility>

#include "engine/blocks/prepare/rectify_params.h"
#include "engine/blocks/stereo/matcher_params.h"
#include "engine/blocks/stereo/sgm_params.h"
#include "engine/core/block.h"
#include "engine/stereo/stereo_matcher.h"

namespace vs {
namespace {

class StereoDepth final : public Block {
 public:
  In<StereoFrame> pair{this, "pair", "The pair as the cameras took it."};
  Out<Frame> left{this, "left",
                  "The rectified left picture, whose pixels disparity and depth belong to."};
  Out<DisparityMap> disparity{this, "disparity",
                              "How far each point moves from the left picture to the right one; "
                              "near points move more."};
  Out<DepthMap> depth{this, "depth",
                      "Distance of each pixel along the camera's axis; unknown where there is no "
                      "disparity."};

  RectifyParams rectify{this};
  MatcherParams who{this};
  SgmParams sgm{this};

  Status CheckParams() const override { return ValidateSettings(sgm.Settings()); }

  Status Start() override {
    VS_RETURN_IF_ERROR(rectify.Start(environment()));
    VS_ASSIGN_OR_RETURN(matcher_, who.MakeMatcher());
    // For what the cameras were calibrated with: a rig that is wrong, or a device without room for
    // it, is told now and not with the first pair.
    const CameraModel& camera = rectify.rig().left;
    VS_ASSIGN_OR_RETURN(const Rectifier* rectifier, rectify.For(camera.width, camera.height));
    return matcher_->Reserve(PlanOf(*rectifier), camera.width, camera.height);
  }

  Status Run() override {
    if (pair->left == nullptr || pair->right == nullptr) {
      return InvalidArgument("a picture of the pair is missing");
    }
    if (pair->geometry) {
      return FailedPrecondition(
          "this pair is rectified already; use SgmStereo and DisparityToDepth in place of this "
          "block");
    }
    const GreyImage& raw = pair->left->image;
    VS_ASSIGN_OR_RETURN(const Rectifier* rectifier, rectify.For(raw.width(), raw.height()));
    VS_ASSIGN_OR_RETURN(
        StereoResult result,
        matcher_->Process(raw, pair->right->image, PlanOf(*rectifier), who.Threads(), pool()));
    Frame picture = *pair->left;
    picture.image = std::move(result.left);
    left.Set(std::move(picture));
    disparity.Set(std::move(result.disparity));
    depth.Set(std::move(result.depth));
    return {};
  }

  void Stop() override { matcher_.reset(); }

 private:
  StereoPlan PlanOf(const Rectifier& rectifier) const {
    return {.rectification = rectifier.rectification(),
            .settings = sgm.Settings(),
            .region = sgm.Region(),
            .depth = true};
  }

  std::unique_ptr<StereoMatcher> matcher_;
};

VS_REGISTER_BLOCK(
    StereoDepth,
    {.category = "Stereo",
     .doc = "Rectifies a pair, matches it and computes depth: exactly what RectifyPair, SgmStereo "
            "and DisparityToDepth give one after the other. Take it where a GPU matches: pictures "
            "go there once and depth comes back once. Take the three blocks to work on what lies "
            "between them."});

}  // namespace
}  // namespace vs
