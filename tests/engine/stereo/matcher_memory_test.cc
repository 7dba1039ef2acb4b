// A warm matcher takes no memory, whatever it has to do.
#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <string>

#include "engine/stereo/sgm_presets.h"
#include "engine/stereo/stereo_matcher.h"
#include "tests/engine/stereo/pictures.h"
#include "tests/support/count_allocations.h"

namespace vs {
namespace {

class MatcherMemory : public testing::TestWithParam<const char*> {
 protected:
  void ExpectNoneWhenWarm(const SgmSettings& settings, int threads) {
    const auto match = [&] {
      ASSERT_TRUE(matcher_->Match(pair_.left, pair_.right, settings, threads, pool_).has_value());
    };
    for (int warm_up = 0; warm_up < 3; ++warm_up) match();
    const uint64_t before = test::Allocations();
    match();
    EXPECT_EQ(test::Allocations(), before);
  }

  BufferPool pool_;
  std::mt19937 random_{3};
  RandomPair pair_ = MakeRandomPair(pool_, 210, 90, random_);
  std::unique_ptr<StereoMatcher> matcher_ = *StereoMatchers::Get().Make(GetParam());
};

TEST_P(MatcherMemory, EveryPresetTakesNoneWhenWarm) {
  for (const std::string_view preset : SgmPresetNames()) {
    SCOPED_TRACE(preset);
    ExpectNoneWhenWarm(*ApplySgmPreset(preset, {.num_disparities = 100}), 2);
  }
}

TEST_P(MatcherMemory, NorDoTheOtherSteps) {
  SgmSettings settings{.num_disparities = 100};
  settings.pre_blur = PreBlur::kStrong;
  settings.window_width = 5;
  settings.window_height = 3;
  settings.fill_background = true;
  for (const int threads : {1, 3, 6}) {
    SCOPED_TRACE(threads);
    ExpectNoneWhenWarm(settings, threads);
  }
}

INSTANTIATE_TEST_SUITE_P(Backends, MatcherMemory, testing::Values("cpu", "reference"),
                         [](const auto& param) { return std::string(param.param); });

}  // namespace
}  // namespace vs
