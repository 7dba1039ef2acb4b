#include "engine/stereo/quality.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

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

// A plane through (0, 0, 1 m) whose normal is tilted by atan(0.5) from the optical axis.
class PlaneTest : public testing::Test {
 protected:
  void SetUp() override {
    map_ = {.depth_m = Image<float>(pool_, 80, 60),
            .geometry = {.width = 80,
                         .height = 60,
                         .focal_px = 100,
                         .baseline_m = 0.1,
                         .cx_px = 40,
                         .cy_px = 30}};
    // z = 1 + 0.5 x, x = (u - 40) z / 100
    for (int v = 0; v < 60; ++v) {
      for (int u = 0; u < 80; ++u) {
        map_.depth_m.Row(v)[u] = static_cast<float>(1 / (1 - 0.5 * (u - 40) / 100.0));
      }
    }
  }
  BufferPool pool_;
  DepthMap map_;
  const PixelRect all_{0, 0, 80, 60};
};

TEST_F(PlaneTest, IsFoundExactly) {
  const auto fit = FitPlane(map_, all_);
  ASSERT_TRUE(fit.has_value());
  EXPECT_NEAR(fit->rms_m, 0, 1e-6);
  EXPECT_NEAR(fit->tilt_deg, 26.565, 1e-3);                 // atan(0.5)
  EXPECT_NEAR(fit->distance_m, 1 / std::sqrt(1.25), 1e-5);  // of the camera from the plane
  EXPECT_EQ(fit->used_percent, 100);
}

TEST_F(PlaneTest, NoiseIsMeasuredAndOutliersAreLeftOut) {
  std::mt19937 random(7);
  std::normal_distribution<float> noise(0, 0.002F);
  for (int v = 0; v < 60; ++v) {
    for (int u = 0; u < 80; ++u) map_.depth_m.Row(v)[u] += noise(random);
  }
  for (int v = 0; v < 60; ++v) {
    for (int u = 0; u < 12; ++u) map_.depth_m.Row(v)[u] = u % 2 == 0 ? 3.0F : NAN;  // 8 % wrong
  }
  const auto fit = FitPlane(map_, all_);
  ASSERT_TRUE(fit.has_value());
  // Along the normal: 2 mm / sqrt(1.25), a little less for the cut tails.
  EXPECT_NEAR(fit->rms_m, 0.00178, 0.0001);
  EXPECT_NEAR(fit->tilt_deg, 26.565, 0.1);
  EXPECT_NEAR(fit->used_percent, 92, 1.5);
}

TEST_F(PlaneTest, NeedsPointsThatSpanAPlane) {
  const auto few = FitPlane(map_, {0, 0, 5, 3});
  ASSERT_FALSE(few.has_value());
  EXPECT_EQ(few.error().message(),
            "plane fit: the region has 15 valid pixels; it needs at least 16");
  EXPECT_FALSE(FitPlane(map_, {0, 10, 80, 1}).has_value()) << "a line";
  map_.geometry.focal_px = 0;
  EXPECT_EQ(FitPlane(map_, all_).error().code(), StatusCode::kFailedPrecondition);
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
