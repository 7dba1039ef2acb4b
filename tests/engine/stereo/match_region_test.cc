#include "engine/stereo/match_region.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "engine/stereo/match_right_view.h"
#include "tests/engine/stereo/map_difference.h"
#include "tests/engine/stereo/pictures.h"

namespace vs {
namespace {

using testing::HasSubstr;

class MatchRegionTest : public testing::Test {
 protected:
  static constexpr int kWidth = 240;
  static constexpr int kHeight = 160;

  MatchRegionTest() : pair_(MakeRandomPair(pool_, kWidth, kHeight, random_)) {}

  DisparityMap Match(const PixelRect& region) {
    auto map = MatchRegion(*matcher_, pair_.left, pair_.right, region, settings_, 2, pool_);
    EXPECT_TRUE(map.has_value()) << map.error().ToString();
    return *std::move(map);
  }
  DisparityMap MatchRight(const PixelRect& region) {
    auto map = MatchRightView(*matcher_, pair_.left, pair_.right, region, settings_, 2, pool_);
    EXPECT_TRUE(map.has_value()) << map.error().ToString();
    return *std::move(map);
  }
  // Masked outside of `region`, and inside hardly different from `whole`.
  static void ExpectPartOf(const DisparityMap& whole, const PixelRect& region,
                           const DisparityMap& part) {
    ASSERT_TRUE(part.disparity.SameSizeAs(whole.disparity));
    EXPECT_EQ(part.offset_px, whole.offset_px);
    int equal = 0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const bool inside = x >= region.x && x < region.x + region.width && y >= region.y &&
                            y < region.y + region.height;
        const auto reason = static_cast<InvalidReason>(part.reason.Row(y)[x]);
        ASSERT_EQ(!inside, reason == InvalidReason::kMasked) << x << " " << y;
        ASSERT_EQ(part.disparity.Row(y)[x] == kInvalidDisparity, reason != InvalidReason::kNone);
        if (!inside) {
          ASSERT_EQ(part.confidence.Row(y)[x], 0);
        }
        if (inside && part.disparity.Row(y)[x] == whole.disparity.Row(y)[x]) ++equal;
      }
    }
    EXPECT_GT(equal, 0.97 * region.width * region.height);
  }

  BufferPool pool_;
  std::mt19937 random_{7};
  RandomPair pair_;
  SgmSettings settings_{.min_disparity = -4, .num_disparities = 24};
  std::unique_ptr<StereoMatcher> matcher_ = *StereoMatchers::Get().Make("auto");
};

TEST_F(MatchRegionTest, ARegionIsAPartOfTheWhole) {
  const DisparityMap whole = Match({0, 0, kWidth, kHeight});
  for (const PixelRect& region : {PixelRect{90, 60, 50, 40},    // in the middle
                                  PixelRect{0, 0, 40, 30},      // a corner
                                  PixelRect{200, 120, 40, 40},  // the other corner
                                  PixelRect{120, 80, 8, 1}}) {  // less than a matcher accepts
    ExpectPartOf(whole, region, Match(region));
  }
}

TEST_F(MatchRegionTest, ARegionOfTheRightView) {
  const PixelRect region = {70, 50, 60, 50};
  ExpectPartOf(MatchRight({0, 0, kWidth, kHeight}), region, MatchRight(region));
}

TEST_F(MatchRegionTest, WhatReachesBeyondThePictureIsLeftOut) {
  ASSERT_EQ(MapDifference(Match({0, 0, 16384, 16384}), Match({0, 0, kWidth, kHeight})), "");
  ASSERT_EQ(MapDifference(Match({100, 90, 16384, 16384}), Match({100, 90, 140, 70})), "");
}

TEST_F(MatchRegionTest, ARegionOutsideThePictureIsRefused) {
  for (const PixelRect& region :
       {PixelRect{kWidth, 0, 10, 10}, PixelRect{10, kHeight + 5, 9, 9}, PixelRect{10, 10, 0, 5}}) {
    const auto map = MatchRegion(*matcher_, pair_.left, pair_.right, region, settings_, 1, pool_);
    ASSERT_FALSE(map.has_value());
    EXPECT_EQ(map.error().code(), StatusCode::kInvalidArgument);
    EXPECT_THAT(map.error().message(), HasSubstr("outside the picture of 240 x 160 px"));
  }
}

TEST_F(MatchRegionTest, WrongSettingsAndPicturesAreRefusedFirst) {
  settings_.directions = 9;
  EXPECT_FALSE(MatchRegion(*matcher_, pair_.left, pair_.right, {0, 0, 20, 20}, settings_, 1, pool_)
                   .has_value());
  settings_.directions = 4;
  const GreyImage small(pool_, kWidth - 1, kHeight);
  EXPECT_FALSE(
      MatchRegion(*matcher_, pair_.left, small, {0, 0, 20, 20}, settings_, 1, pool_).has_value());
}

}  // namespace
}  // namespace vs
