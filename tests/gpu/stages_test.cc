// All stages together, run by the emulation: what the reference matcher computes, to the last bit.
#include "gpu/stages.h"

#include <gtest/gtest.h>

#include <memory>
#include <random>

#include "engine/stereo/stereo_matcher.h"
#include "gpu/emulation/emulated_executor.h"
#include "tests/engine/stereo/map_difference.h"
#include "tests/engine/stereo/pictures.h"
#include "tests/engine/stereo/random_settings.h"

namespace vs::gpu {
namespace {

class Stages : public testing::Test {
 protected:
  void ExpectEqual(const RandomPair& pair, const SgmSettings& settings) {
    const int width = pair.left.width();
    const int height = pair.left.height();
    const auto expected = reference_->Match(pair.left, pair.right, settings, 2, pool_);
    ASSERT_TRUE(expected.has_value()) << expected.error().ToString();
    ASSERT_TRUE(executor_->Prepare({.settings = settings}, width, height).ok());
    const auto result = executor_->Run(pair.left, pair.right, pool_);
    ASSERT_TRUE(result.has_value()) << result.error().ToString();
    ASSERT_EQ(MapDifference(result->disparity, *expected), "")
        << width << " x " << height << " px, " << Describe(settings);
  }

  BufferPool pool_;
  std::unique_ptr<StereoMatcher> reference_ = *StereoMatchers::Get().Make("reference");
  std::unique_ptr<Executor> executor_ = MakeEmulatedExecutor(7);
  std::mt19937 random_{20261123};
};

TEST_F(Stages, EqualTheReferenceOnRandomPicturesAndSettings) {
  for (int round = 0; round < 60; ++round) {
    const RandomPair pair =
        MakeRandomPair(pool_, 16 + Below(random_, 60), 16 + Below(random_, 16), random_);
    ExpectEqual(pair, MakeRandomSettings(random_, 256));
    if (HasFatalFailure()) return;
  }
}

TEST_F(Stages, EqualTheReferenceForEveryNumberOfDirections) {
  const RandomPair pair = MakeRandomPair(pool_, 61, 40, random_);
  for (int directions = 1; directions <= 8; ++directions) {
    ExpectEqual(pair, {.num_disparities = 70, .directions = directions});
    if (HasFatalFailure()) return;
  }
}

TEST_F(Stages, EqualTheReferenceForEveryRange) {
  const RandomPair pair = MakeRandomPair(pool_, 70, 16, random_);
  for (const int range : {1, 2, 7, 8, 9, 63, 64, 65, 127, 128, 129, 192, 196, 255, 256}) {
    for (const int first : {-300, 0, 50}) {
      ExpectEqual(pair, {.min_disparity = first, .num_disparities = range});
      if (HasFatalFailure()) return;
    }
  }
}

}  // namespace
}  // namespace vs::gpu
