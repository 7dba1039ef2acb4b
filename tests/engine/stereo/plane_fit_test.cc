#include "engine/stereo/plane_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace vs {
namespace {

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
  const auto fit = FitPlane(map_, all_, pool_);
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
  const auto fit = FitPlane(map_, all_, pool_);
  ASSERT_TRUE(fit.has_value());
  // Along the normal: 2 mm / sqrt(1.25), a little less for the cut tails.
  EXPECT_NEAR(fit->rms_m, 0.00178, 0.0001);
  EXPECT_NEAR(fit->tilt_deg, 26.565, 0.1);
  EXPECT_NEAR(fit->used_percent, 92, 1.5);
}

TEST_F(PlaneTest, OfALargeRegionTakesMemoryForWhatIsLookedAtOnly) {
  map_.depth_m = Image<float>(pool_, 1000, 800);
  for (int v = 0; v < 800; ++v) std::fill_n(map_.depth_m.Row(v), 1000, 2.0F);
  BufferPool scratch;
  const auto fit = FitPlane(map_, {0, 0, 1000, 800}, scratch);
  ASSERT_TRUE(fit.has_value());
  EXPECT_EQ(fit->pixels, 200 * 160) << "every fifth row and column: 800000 / 25";
  // Four numbers of 8 bytes for each; a slab may be up to twice what is asked for.
  EXPECT_LE(scratch.BytesHeld(), 2 * 32'000 * 32U);
}

TEST_F(PlaneTest, NeedsPointsThatSpanAPlane) {
  const auto few = FitPlane(map_, {0, 0, 5, 3}, pool_);
  ASSERT_FALSE(few.has_value());
  EXPECT_EQ(few.error().message(),
            "plane fit: the region has 15 valid pixels; it needs at least 16");
  EXPECT_FALSE(FitPlane(map_, {0, 10, 80, 1}, pool_).has_value()) << "a line";
  map_.geometry.focal_px = 0;
  EXPECT_EQ(FitPlane(map_, all_, pool_).error().code(), StatusCode::kFailedPrecondition);
}

}  // namespace
}  // namespace vs
