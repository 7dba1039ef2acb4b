// A raw pair's whole way through the stages, run by the emulation: what the host computes, to the
// last bit.
#include <gtest/gtest.h>

#include <memory>
#include <random>

#include "engine/base/clock.h"
#include "engine/stereo/stereo_matcher.h"
#include "gpu/cuda_matcher.h"
#include "gpu/emulation/emulated_executor.h"
#include "tests/engine/stereo/map_difference.h"
#include "tests/engine/stereo/random_rectification.h"

namespace vs::gpu {
namespace {

class Process : public testing::Test {
 protected:
  void ExpectEqual(const RandomPair& pair, const StereoPlan& plan) {
    const auto expected = reference_->Process(pair.left, pair.right, plan, 2, pool_);
    ASSERT_TRUE(expected.has_value()) << expected.error().ToString();
    const auto result = matcher_->Process(pair.left, pair.right, plan, 1, pool_);
    ASSERT_TRUE(result.has_value()) << result.error().ToString();
    EXPECT_EQ(ResultDifference(*result, *expected), "") << Describe(plan.settings);
  }

  BufferPool pool_;
  SystemClock clock_;
  DeviceBoard board_{1};
  std::unique_ptr<StereoMatcher> reference_ = *StereoMatchers::Get().Make("reference");
  std::unique_ptr<StereoMatcher> matcher_ =
      *MakeCudaMatcher({.make_executor = [](int) -> Result<std::unique_ptr<Executor>> {
                          return MakeEmulatedExecutor(7);
                        },
                        .make_substitute = []() -> Result<std::unique_ptr<StereoMatcher>> {
                          return Unavailable("the emulation failed");
                        },
                        .clock = &clock_,
                        .board = &board_},
                       0);
  std::mt19937 random_{20261123};
};

TEST_F(Process, EqualsTheHostFromRawPicturesToDepth) {
  for (int round = 0; round < 24; ++round) {
    const RandomPair pair =
        MakeRandomPair(pool_, 34 + Below(random_, 60), 34 + Below(random_, 20), random_);
    const RectificationKind kind{.interpolation = static_cast<Interpolation>(round % 3),
                                 .exact = Below(random_, 2) == 0,
                                 .half_size = Below(random_, 2) == 0};
    const StereoPlan plan{
        .rectification = MakeRandomRectification(pair.left, 16 + Below(random_, 50),
                                                 16 + Below(random_, 12), random_, kind),
        .settings = MakeRandomSettings(random_, 256),
        .depth = round % 4 != 0};
    ExpectEqual(pair, plan);
    if (HasFailure()) return;
  }
}

TEST_F(Process, EqualsTheHostForPicturesThatAreRectified) {
  const RandomPair pair = MakeRandomPair(pool_, 50, 20, random_);
  const RectifiedGeometry geometry{.width = 50, .height = 20, .focal_px = 500, .baseline_m = 0.1};
  ExpectEqual(pair, {.geometry = geometry, .settings = {.num_disparities = 16}, .depth = true});
  ExpectEqual(pair, {.settings = {.num_disparities = 16}});
}

TEST_F(Process, EqualsTheHostInARegion) {
  const RandomPair pair = MakeRandomPair(pool_, 60, 30, random_);
  ExpectEqual(pair, {.rectification = MakeRandomRectification(pair.left, 80, 40, random_),
                     .settings = {.num_disparities = 16},
                     .region = PixelRect{50, 10, 20, 20},
                     .depth = true});
}

}  // namespace
}  // namespace vs::gpu
