#include "engine/stereo/quality.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/engine/stereo/pictures.h"

namespace vs {
namespace {

TEST(ValidPercent, CountsTheRegionInsideThePicture) {
  BufferPool pool;
  const DisparityMap map = MakeMap(pool, {{16, 0, 16, 16}, {0, 0, 16, 16}});
  EXPECT_DOUBLE_EQ(ValidPercent(map, {0, 0, 4, 2}), 62.5);
  EXPECT_DOUBLE_EQ(ValidPercent(map, {-5, -5, 7, 7}), 25);
  EXPECT_DOUBLE_EQ(ValidPercent(map, {2, 0, 2000000000, 2000000000}), 100);
  EXPECT_DOUBLE_EQ(ValidPercent(map, {4, 0, 10, 10}), 0);
}

TEST(ScoreAgainstTruth, CountsInvalidPixelsAsBad) {
  BufferPool pool;
  //                                 exact, 0.5 high, 1.5 low, 3 low, invalid, hidden, unknown
  DisparityMap map = MakeMap(pool, {{160, 168, 136, 112, 0, 900, 900}});
  map.geometry.focal_px = 100;
  const StereoTruth truth{.disparity_px = MakeImage<float>(pool, {{10, 10, 10, 10, 10, 10, NAN}}),
                          .visible = MakeImage<uint8_t>(pool, {{255, 255, 255, 255, 255, 0, 255}})};
  const auto score = ScoreAgainstTruth(map, truth, {0, 0, 7, 1});
  ASSERT_TRUE(score.has_value());
  EXPECT_EQ(score->pixels, 5);
  EXPECT_DOUBLE_EQ(score->valid_percent, 80);
  EXPECT_DOUBLE_EQ(score->bad1_percent, 60);
  EXPECT_DOUBLE_EQ(score->bad2_percent, 40);
  EXPECT_DOUBLE_EQ(score->valid_bad1_percent, 50);
  EXPECT_DOUBLE_EQ(score->valid_bad2_percent, 25);
  EXPECT_DOUBLE_EQ(score->average_error_px, (0 + 0.5 + 1.5 + 3) / 4);
  EXPECT_DOUBLE_EQ(score->mean_error_px, 0.25);
  EXPECT_NEAR(score->depth_bias_percent, 100 * (0 + (10 / 10.5 - 1)) / 2, 1e-9);
}

TEST(ScoreAgainstTruth, NeedsTruthOfTheSameSize) {
  BufferPool pool;
  const DisparityMap map = MakeMap(pool, {{160, 160}});
  const StereoTruth truth{.disparity_px = MakeImage<float>(pool, {{10}}),
                          .visible = MakeImage<uint8_t>(pool, {{255}})};
  EXPECT_EQ(ScoreAgainstTruth(map, truth, {0, 0, 2, 1}).error().code(),
            StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace vs
