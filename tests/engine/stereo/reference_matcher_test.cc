#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <random>

#include "engine/base/check.h"
#include "engine/base/str.h"
#include "engine/stereo/match_right_view.h"
#include "engine/stereo/stereo_matcher.h"
#include "tests/engine/stereo/map_difference.h"
#include "tests/engine/stereo/naive_sgm.h"
#include "tests/engine/stereo/pictures.h"
#include "tests/engine/stereo/random_settings.h"

namespace vs {
namespace {

using testing::Contains;
using testing::HasSubstr;

class ReferenceMatcher : public testing::Test {
 protected:
  DisparityMap Match(const RandomPair& pair, const SgmSettings& settings, int threads = 1) {
    auto map = matcher_->Match(pair.left, pair.right, settings, threads, pool_);
    EXPECT_TRUE(map.has_value()) << map.error().ToString();
    return map.has_value() ? *map : DisparityMap{};
  }

  BufferPool pool_;
  std::unique_ptr<StereoMatcher> matcher_ = *StereoMatchers::Get().Make("reference");
  std::mt19937 random_{20240611};
};

TEST_F(ReferenceMatcher, EqualsTheDefinitionOnRandomPicturesAndSettings) {
  for (int round = 0; round < 100; ++round) {
    const int width = 16 + Below(random_, 40);
    const int height = 16 + Below(random_, 14);
    const RandomPair pair = MakeRandomPair(pool_, width, height, random_);
    const SgmSettings settings = MakeRandomSettings(random_, 40);
    ASSERT_EQ(
        MapDifference(Match(pair, settings), NaiveSgm(pair.left, pair.right, settings, pool_)), "")
        << "round " << round << ", " << width << " x " << height << " px, " << Describe(settings);
  }
}

TEST_F(ReferenceMatcher, EqualsTheDefinitionWithTheRecommendedSettings) {
  const RandomPair pair = MakeRandomPair(pool_, 70, 33, random_);
  for (const int directions : {1, 4, 7, 8}) {
    const SgmSettings settings{.num_disparities = 24, .directions = directions};
    EXPECT_EQ(
        MapDifference(Match(pair, settings), NaiveSgm(pair.left, pair.right, settings, pool_)), "");
  }
}

TEST_F(ReferenceMatcher, EqualsTheDefinitionOverTheWholeRange) {
  const RandomPair pair = MakeRandomPair(pool_, 300, 16, random_);
  const SgmSettings settings{.num_disparities = 256, .smooth_cost = false, .directions = 8};
  EXPECT_EQ(MapDifference(Match(pair, settings), NaiveSgm(pair.left, pair.right, settings, pool_)),
            "");
}

TEST_F(ReferenceMatcher, TheNumberOfThreadsDoesNotChangeTheResult) {
  for (int round = 0; round < 30; ++round) {
    const RandomPair pair =
        MakeRandomPair(pool_, 16 + Below(random_, 90), 16 + Below(random_, 60), random_);
    const SgmSettings settings = MakeRandomSettings(random_, 48);
    const DisparityMap one = Match(pair, settings, 1);
    for (const int threads : {2, 3, 16, 1000}) {
      ASSERT_EQ(MapDifference(Match(pair, settings, threads), one), "")
          << threads << " threads, " << Describe(settings);
    }
  }
}

TEST_F(ReferenceMatcher, ValidityReasonAndConfidenceAgree) {
  for (int round = 0; round < 60; ++round) {
    const RandomPair pair =
        MakeRandomPair(pool_, 17 + Below(random_, 90), 17 + Below(random_, 60), random_);
    const SgmSettings settings = MakeRandomSettings(random_, 64);
    const DisparityMap map = Match(pair, settings);
    const int offset = settings.min_disparity < 0 ? settings.min_disparity - 1 : 0;
    ASSERT_EQ(map.offset_px, offset);
    const int least = 16 * (settings.min_disparity - offset) - 8;
    const int greatest = 16 * (settings.min_disparity + settings.num_disparities - 1 - offset) + 8;
    for (int y = 0; y < map.disparity.height(); ++y) {
      for (int x = 0; x < map.disparity.width(); ++x) {
        const bool valid = map.disparity.Row(y)[x] != kInvalidDisparity;
        ASSERT_EQ(valid, map.reason.Row(y)[x] == 0) << Describe(settings);
        ASSERT_EQ(valid, map.confidence.Row(y)[x] > 0) << Describe(settings);
        ASSERT_LT(map.reason.Row(y)[x], kInvalidReasonCount);
        if (!valid) continue;
        ASSERT_GE(map.disparity.Row(y)[x], least) << Describe(settings);
        ASSERT_LE(map.disparity.Row(y)[x], greatest) << Describe(settings);
      }
    }
  }
}

TEST_F(ReferenceMatcher, FindsAShiftedPicture) {
  GreyImage left(pool_, 101, 37);
  GreyImage right(pool_, 101, 37);
  for (int y = 0; y < 37; ++y) {
    for (int x = 0; x < 101; ++x) left.Row(y)[x] = static_cast<uint8_t>(10 + Below(random_, 230));
  }
  for (int y = 0; y < 37; ++y) {
    for (int x = 0; x < 101; ++x) right.Row(y)[x] = left.Row(y)[std::min(x + 9, 100)];
  }
  const DisparityMap map = Match({left, right}, {.num_disparities = 32});
  for (int y = 0; y < 37; ++y) {
    for (int x = 12; x < 101; ++x) ASSERT_NEAR(map.disparity.Row(y)[x], 16 * 9, 8) << x << " " << y;
  }
}

TEST_F(ReferenceMatcher, WithoutPenaltiesTheCheapestPixelWins) {
  const RandomPair pair = MakeRandomPair(pool_, 40, 20, random_);
  SgmSettings settings{.num_disparities = 16,
                       .pre_blur = PreBlur::kOff,
                       .match_gain = false,
                       .cost = MatchCost::kSad,
                       .smooth_cost = false,
                       .directions = 1,
                       .p1 = 0,
                       .p2 = 0,
                       .sub_pixel = SubPixel::kOff,
                       .left_right_check = false,
                       .median = 0,
                       .speckle_size = 0,
                       .gated_median = false,
                       .fill_holes = false};
  const DisparityMap map = Match(pair, settings);
  for (int y = 0; y < 20; ++y) {
    for (int x = 16; x < 40; ++x) {
      int best = 0;
      const auto cost = [&](int d) {
        return std::min(std::abs(pair.left.Row(y)[x] - pair.right.Row(y)[x - d]), 63);
      };
      for (int d = 1; d < 16; ++d) best = cost(d) < cost(best) ? d : best;
      EXPECT_EQ(map.disparity.Row(y)[x], best == 0 ? kInvalidDisparity : 16 * best);
    }
  }
}

TEST_F(ReferenceMatcher, MatchesTheLargestPicture) {
  GreyImage picture(pool_, kMaxPictureWidth, kMaxPictureHeight);
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) {
      picture.Row(y)[x] = static_cast<uint8_t>((x * 7919 + y * 104729) >> 3);
    }
  }
  const DisparityMap map =
      Match({picture, picture}, {.min_disparity = -1, .num_disparities = 3, .directions = 1}, 2);
  EXPECT_NEAR(map.disparity.Row(3071)[4000], 16 * 2, 2) << "0 px above an offset of -2";
}

TEST_F(ReferenceMatcher, TheRightViewMirrorsTheLeft) {
  GreyImage left(pool_, 60, 20);
  GreyImage right(pool_, 60, 20);
  for (int y = 0; y < 20; ++y) {
    for (int x = 0; x < 60; ++x) left.Row(y)[x] = static_cast<uint8_t>(10 + Below(random_, 230));
    for (int x = 0; x < 60; ++x) right.Row(y)[x] = left.Row(y)[std::min(x + 5, 59)];
  }
  const auto map =
      MatchRightView(*matcher_, left, right, {0, 0, 64, 40}, {.num_disparities = 16}, 1, pool_);
  ASSERT_TRUE(map.has_value());
  EXPECT_NEAR(map->disparity.Row(10)[30], 16 * 5, 1);
  EXPECT_NEAR(map->disparity.Row(10)[5], 16 * 5, 1) << "the right view has its border on the right";
  EXPECT_EQ(map->reason.Row(10)[59] == 0, map->disparity.Row(10)[59] != 0);
}

TEST_F(ReferenceMatcher, RefusesPicturesItCannotMatch) {
  const auto error_of = [&](int left_width, int left_height, int right_width, int right_height) {
    const auto map = matcher_->Match(GreyImage(pool_, left_width, left_height),
                                     GreyImage(pool_, right_width, right_height), {}, 1, pool_);
    EXPECT_FALSE(map.has_value());
    return map.has_value() ? "" : map.error().ToString();
  };
  EXPECT_EQ(error_of(32, 32, 32, 33),
            "INVALID_ARGUMENT: matcher: the left picture has 32 x 32 px, the right one 32 x 33 px; "
            "they must be equal");
  EXPECT_EQ(error_of(15, 32, 15, 32),
            "INVALID_ARGUMENT: matcher: the pictures have 15 x 32 px; the size must be 16 x 16 to "
            "4096 x 3072 px");
  EXPECT_THAT(error_of(0, 0, 0, 0), HasSubstr("0 x 0 px"));
  EXPECT_THAT(error_of(4097, 16, 4097, 16), HasSubstr("4097 x 16 px"));
}

TEST_F(ReferenceMatcher, RefusesWrongSettings) {
  const GreyImage picture(pool_, 32, 32);
  const auto map = matcher_->Match(picture, picture, {.num_disparities = 0}, 1, pool_);
  ASSERT_FALSE(map.has_value());
  EXPECT_THAT(map.error().faults(),
              Contains(Fault{"num_disparities", "is 0 px; it must be 1 .. 256 px"}));
}

TEST_F(ReferenceMatcher, AWarmMatcherTakesNoNewPictureMemory) {
  const RandomPair pair = MakeRandomPair(pool_, 64, 48, random_);
  { const DisparityMap first = Match(pair, {.num_disparities = 32}, 2); }
  const uint64_t slabs = pool_.SlabsMade();
  for (int k = 0; k < 5; ++k) const DisparityMap next = Match(pair, {.num_disparities = 32}, 2);
  EXPECT_EQ(pool_.SlabsMade(), slabs);
}

TEST(SgmSettings, AllWrongFieldsAreNamedAtOnce) {
  const Status status = ValidateSettings({.min_disparity = -2049,
                                          .num_disparities = 257,
                                          .cost = static_cast<MatchCost>(9),
                                          .ad_limit = 17,
                                          .grey_limit = 0,
                                          .sobel_cap = 128,
                                          .outside_cost = 64,
                                          .window_width = 16,
                                          .window_height = 0,
                                          .smooth_cost_gate = 256,
                                          .directions = 9,
                                          .p1 = 66,
                                          .p2 = 65,
                                          .p2_min = -1,
                                          .p2_slope_permille = 1001,
                                          .uniqueness_percent = 51,
                                          .min_confidence = 256,
                                          .left_right_tolerance = 9,
                                          .median = 4,
                                          .speckle_size = -1,
                                          .speckle_step = 0,
                                          .gate = -1});
  EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
  EXPECT_EQ(status.faults().size(), 22u) << status.ToString();
  EXPECT_THAT(status.faults(), Contains(Fault{"cost", "is choice 9; there are 0 .. 3"}));
  EXPECT_THAT(status.faults(), Contains(Fault{"p1", "is 66; it must be 0 .. p2, which is 65"}));
  EXPECT_THAT(status.faults(), Contains(Fault{"median", "is 4 px; it must be 0 (off), 3 or 5 px"}));
  EXPECT_TRUE(ValidateSettings({}).ok());
}

TEST(StereoMatchers, RefuseTwoBackendsOfOneName) {
  StereoMatchers matchers;
  const auto nowhere = [] { return NotFound("no device"); };
  matchers.Add("cuda", 200, nowhere);
  EXPECT_THROW(matchers.Add("cuda", 100, nowhere), BrokenInvariant);
  EXPECT_THAT(matchers.Names(), testing::ElementsAre("cuda"));
}

TEST(StereoMatchers, AutoTakesTheFastestThatRuns) {
  StereoMatchers matchers;
  const auto broken = [] {
    return Result<std::unique_ptr<StereoMatcher>>(Unavailable("no such device"));
  };
  const auto working = [] { return StereoMatchers::Get().Make("reference"); };
  matchers.Add("slow", 0, working);
  matchers.Add("gpu", 200, broken);
  matchers.Add("fast", 100, working);
  EXPECT_EQ(matchers.Names(), (std::vector<std::string>{"gpu", "fast", "slow"}));
  EXPECT_TRUE(matchers.Make("auto").has_value());
  const auto chosen = matchers.Make("gpu");
  ASSERT_FALSE(chosen.has_value());
  EXPECT_EQ(chosen.error().message(), "no such device");
  const auto unknown = matchers.Make("tpu");
  ASSERT_FALSE(unknown.has_value());
  EXPECT_EQ(unknown.error().ToString(),
            "NOT_FOUND: there is no matcher \"tpu\" that runs on this machine; choose auto, gpu, "
            "fast, slow");
  EXPECT_FALSE(StereoMatchers().Make("auto").has_value());
}

}  // namespace
}  // namespace vs
