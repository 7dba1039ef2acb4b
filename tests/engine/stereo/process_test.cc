// The whole way of a pair in one call, against its steps one by one.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <string>

#include "engine/stereo/depth.h"
#include "engine/stereo/match_region.h"
#include "engine/stereo/stereo_matcher.h"
#include "tests/engine/stereo/map_difference.h"
#include "tests/engine/stereo/pictures.h"
#include "tests/engine/stereo/random_rectification.h"

namespace vs {
namespace {

using testing::HasSubstr;

class Process : public testing::Test {
 protected:
  Process() {
    plan_.rectification = MakeRandomRectification(pair_.left, 50, 24, random_);
    plan_.settings.num_disparities = 16;
    plan_.depth = true;
  }

  std::string Error(const StereoPlan& plan) {
    const auto result = matcher_->Process(pair_.left, pair_.right, plan, 1, pool_);
    return result.has_value() ? "" : result.error().ToString();
  }

  BufferPool pool_;
  std::mt19937 random_{20261123};
  RandomPair pair_ = MakeRandomPair(pool_, 60, 30, random_);
  StereoPlan plan_;
  std::unique_ptr<StereoMatcher> matcher_ = *StereoMatchers::Get().Make("reference");
};

TEST_F(Process, IsRectifyingMatchingAndMeasuringInARow) {
  const Rectification& how = *plan_.rectification;
  const GreyImage left = Rectified(pair_.left, how, how.left, pool_);
  const GreyImage right = Rectified(pair_.right, how, how.right, pool_);
  const PixelRect whole{0, 0, 50, 24};
  for (const PixelRect region : {whole, PixelRect{-5, -5, 1000, 1000}, PixelRect{20, 4, 12, 9}}) {
    auto map = *MatchRegion(*matcher_, left, right, region, plan_.settings, 1, pool_);
    map.geometry = how.geometry;
    const DepthMap depth = *DepthFromDisparity(map, pool_);
    for (const std::string& name : StereoMatchers::Get().Names()) {
      plan_.region = region;
      const auto matcher = StereoMatchers::Get().Make(name);
      if (!matcher.has_value()) continue;  // it does not run on this machine
      const auto result = (*matcher)->Process(pair_.left, pair_.right, plan_, 2, pool_);
      ASSERT_TRUE(result.has_value()) << result.error().ToString();
      EXPECT_EQ(RowsOf(result->left), RowsOf(left)) << name;
      EXPECT_EQ(MapDifference(result->disparity, map), "") << name;
      EXPECT_EQ(result->disparity.geometry, how.geometry);
      EXPECT_EQ(DepthDifference(result->depth, depth), "") << name;
    }
  }
}

TEST_F(Process, WithSettingsAloneIsMatching) {
  const auto expected = matcher_->Match(pair_.left, pair_.right, plan_.settings, 1, pool_);
  const auto result =
      matcher_->Process(pair_.left, pair_.right, {.settings = plan_.settings}, 1, pool_);
  ASSERT_TRUE(result.has_value()) << result.error().ToString();
  EXPECT_EQ(MapDifference(result->disparity, *expected), "");
  EXPECT_EQ(result->disparity.geometry, expected->geometry);
  EXPECT_EQ(result->left.Row(0), pair_.left.Row(0)) << "a copy was made for nothing";
  EXPECT_TRUE(result->depth.depth_m.empty());
}

TEST_F(Process, SaysWhatIsWrong) {
  StereoPlan plan = plan_;
  plan.settings.num_disparities = 257;
  EXPECT_THAT(Error(plan), HasSubstr("num_disparities"));
  plan = plan_;
  plan.rectification =
      MakeRandomRectification(MakeRandomPair(pool_, 61, 30, random_).left, 50, 24, random_);
  EXPECT_THAT(Error(plan), HasSubstr("a picture has 60 x 30 px, expected 61 x 30 px"));
  plan.rectification = MakeRandomRectification(pair_.left, 15, 24, random_);
  EXPECT_THAT(Error(plan), HasSubstr("the pictures have 15 x 24 px"));
  plan.rectification = nullptr;
  EXPECT_THAT(Error(plan), HasSubstr("FAILED_PRECONDITION: depth needs the cameras' geometry"));
  plan.geometry = plan_.rectification->geometry;
  EXPECT_EQ(Error(plan), "");
  plan.region = PixelRect{1000, 0, 10, 10};
  EXPECT_THAT(Error(plan), HasSubstr("lies outside the picture"));
}

}  // namespace
}  // namespace vs
