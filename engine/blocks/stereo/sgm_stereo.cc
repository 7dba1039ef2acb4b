// Computes disparity from a rectified pair by semi-global matching.
#include <memory>
#include <string>
#include <utility>

#include "engine/blocks/stereo/matcher_params.h"
#include "engine/blocks/stereo/sgm_params.h"
#include "engine/core/block.h"
#include "engine/stereo/match_region.h"
#include "engine/stereo/match_right_view.h"
#include "engine/stereo/stereo_matcher.h"

namespace vs {
namespace {

class SgmStereo final : public Block {
 public:
  In<StereoFrame> pair{this, "pair", "A rectified pair of pictures."};
  Out<DisparityMap> disparity{this, "disparity",
                              "How far each point moves from the left picture to the right one; "
                              "near points move more."};

  MatcherParams who{this};
  Param<std::string> view{this,
                          "view",
                          {.initial = "left",
                           .choices = {"left", "right"},
                           .doc = "The picture whose pixels get a disparity. Match both views and "
                                  "compare them with the block LeftRightCheck for the strictest "
                                  "check."}};
  SgmParams sgm{this};

  Status CheckParams() const override { return ValidateSettings(sgm.Settings()); }

  Status Start() override {
    VS_ASSIGN_OR_RETURN(matcher_, who.MakeMatcher());
    return {};
  }

  Status Run() override {
    if (pair->left == nullptr || pair->right == nullptr) {
      return InvalidArgument("a picture of the pair is missing");
    }
    const auto match = *view == "right" ? MatchRightView : MatchRegion;
    VS_ASSIGN_OR_RETURN(DisparityMap map,
                        match(*matcher_, pair->left->image, pair->right->image, sgm.Region(),
                              sgm.Settings(), who.Threads(), pool()));
    if (pair->geometry) map.geometry = *pair->geometry;
    disparity.Set(std::move(map));
    return {};
  }

  void Stop() override { matcher_.reset(); }

 private:
  std::unique_ptr<StereoMatcher> matcher_;
};

VS_REGISTER_BLOCK(SgmStereo,
                  {.category = "Stereo",
                   .doc = "Finds for each pixel of one picture its counterpart in the other, by "
                          "semi-global matching. Feed it a rectified pair; the initial values suit "
                          "most scenes, P2 and the search range matter most."});

}  // namespace
}  // namespace vs
