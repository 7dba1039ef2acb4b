// The fast matcher computes what the reference does, to the last bit, whatever the instruction set
// and the number of threads.
#include "engine/stereo/cpu/cpu_matcher.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "engine/stereo/stereo_matcher.h"
#include "tests/engine/stereo/map_difference.h"
#include "tests/engine/stereo/pictures.h"
#include "tests/engine/stereo/random_settings.h"

namespace vs {
namespace {

// By the name of an instruction set.
class CpuMatcher : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    for (const cpu::Kernels* kernels :
         {cpu::Avx512Kernels(), cpu::Avx2Kernels(), cpu::PortableKernels()}) {
      if (kernels != nullptr && kernels->name == std::string(GetParam())) {
        matcher_ = *cpu::MakeCpuMatcher(kernels);
      }
    }
    if (matcher_ == nullptr) GTEST_SKIP() << "this processor has no " << GetParam();
  }

  void ExpectEqual(const RandomPair& pair, const SgmSettings& settings,
                   const std::vector<int>& threads) {
    const auto expected = reference_->Match(pair.left, pair.right, settings, 2, pool_);
    ASSERT_TRUE(expected.has_value()) << expected.error().ToString();
    for (const int count : threads) {
      const auto map = matcher_->Match(pair.left, pair.right, settings, count, pool_);
      ASSERT_TRUE(map.has_value()) << map.error().ToString();
      ASSERT_EQ(MapDifference(*map, *expected), "")
          << pair.left.width() << " x " << pair.left.height() << " px, " << count << " threads, "
          << Describe(settings);
    }
  }

  BufferPool pool_;
  std::unique_ptr<StereoMatcher> reference_ = *StereoMatchers::Get().Make("reference");
  std::unique_ptr<StereoMatcher> matcher_;
  std::mt19937 random_{20261122};
};

TEST_P(CpuMatcher, EqualsTheReferenceOnRandomPicturesAndSettings) {
  for (int round = 0; round < 100; ++round) {
    const RandomPair pair =
        MakeRandomPair(pool_, 16 + Below(random_, 130), 16 + Below(random_, 40), random_);
    const SgmSettings settings = MakeRandomSettings(random_, 256);
    ExpectEqual(pair, settings, {1 + Below(random_, 9)});
    if (HasFatalFailure()) return;
  }
}

TEST_P(CpuMatcher, EqualsTheReferenceForEveryNumberOfDirectionsAndThreads) {
  const RandomPair pair = MakeRandomPair(pool_, 301, 61, random_);
  for (int directions = 1; directions <= 8; ++directions) {
    ExpectEqual(pair, {.num_disparities = 100, .directions = directions}, {1, 2, 3, 4, 16, 1000});
    if (HasFatalFailure()) return;
  }
}

TEST_P(CpuMatcher, EqualsTheReferenceForEveryRange) {
  const RandomPair pair = MakeRandomPair(pool_, 270, 17, random_);
  for (const int range : {1, 2, 3, 16, 31, 63, 64, 65, 127, 128, 129, 191, 192, 196, 255, 256}) {
    for (const int first : {-300, 0, 250}) {
      ExpectEqual(pair, {.min_disparity = first, .num_disparities = range}, {1, 5});
      if (HasFatalFailure()) return;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(InstructionSets, CpuMatcher, testing::Values("avx512", "avx2", "portable"),
                         [](const auto& isa) { return std::string(isa.param); });

}  // namespace
}  // namespace vs
