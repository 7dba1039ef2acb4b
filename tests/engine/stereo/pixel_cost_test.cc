#include "engine/stereo/pixel_cost.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "tests/engine/stereo/pictures.h"

namespace vs {
namespace {

using testing::ElementsAre;

std::vector<int> CostsAt(const GreyImage& left, const GreyImage& right, const SgmSettings& settings,
                         int x, int y) {
  PaddedPicture l;
  PaddedPicture r;
  l.Assign(left, settings.sobel_cap);
  r.Assign(right, settings.sobel_cap);
  PixelCost cost;
  cost.Prepare(&l, &r, settings);
  const auto disparities = static_cast<size_t>(settings.num_disparities);
  std::vector<uint8_t> row(static_cast<size_t>(left.width()) * disparities);
  cost.Row(y, row.data());
  const auto begin = row.begin() + static_cast<std::ptrdiff_t>(x * disparities);
  return {begin, begin + static_cast<std::ptrdiff_t>(disparities)};
}

class PixelCostTest : public testing::Test {
 protected:
  BufferPool pool_;
  const GreyImage left_ = MakeImage<uint8_t>(pool_, {{10, 20, 40, 80, 160, 100}});
  const GreyImage right_ = MakeImage<uint8_t>(pool_, {{40, 80, 160, 100, 90, 30}});
};

TEST_F(PixelCostTest, SadIsTheGreyDifferenceUpToItsLimit) {
  const SgmSettings settings{.num_disparities = 4, .cost = MatchCost::kSad, .outside_cost = 9};
  // Left 80 against right 100, 160, 80, 40.
  EXPECT_THAT(CostsAt(left_, right_, settings, 3, 0), ElementsAre(20, 63, 0, 40));
  // Left 20 against right 80, 40, then outside.
  EXPECT_THAT(CostsAt(left_, right_, settings, 1, 0), ElementsAre(60, 20, 9, 9));
}

TEST_F(PixelCostTest, SearchesFromANegativeMinimum) {
  const SgmSettings settings{
      .min_disparity = -2, .num_disparities = 4, .cost = MatchCost::kSad, .outside_cost = 9};
  // Left 160 at x = 4 against right x = 6 (outside), 5, 4, 3.
  EXPECT_THAT(CostsAt(left_, right_, settings, 4, 0), ElementsAre(9, 63, 63, 60));
}

TEST_F(PixelCostTest, AMinimumBeyondThePictureLeavesOnlyOutsideCosts) {
  SgmSettings settings{
      .min_disparity = 6, .num_disparities = 3, .cost = MatchCost::kSad, .outside_cost = 9};
  EXPECT_THAT(CostsAt(left_, right_, settings, 5, 0), ElementsAre(9, 9, 9));
  settings.min_disparity = -9;
  EXPECT_THAT(CostsAt(left_, right_, settings, 0, 0), ElementsAre(9, 9, 9));
}

TEST_F(PixelCostTest, BirchfieldTomasiForgivesHalfAPixel) {
  const SgmSettings settings{
      .num_disparities = 3, .cost = MatchCost::kBirchfieldTomasi, .outside_cost = 9};
  // Left 80 (half-way values 60 and 120) at d = 0 against right 100 (half-way 130 and 95):
  // a = 95 - 80 = 15, b = max(0, 100 - 120, 60 - 100) = 0.
  // d = 1: right 160 (half-way 120 and 130): a = 120 - 80 = 40, b = 160 - 120 = 40.
  // d = 2: right 80: equal.
  EXPECT_THAT(CostsAt(left_, right_, settings, 3, 0), ElementsAre(0, 40, 0));
}

TEST_F(PixelCostTest, AdCensusAddsTheTruncatedCoarseDifference) {
  SgmSettings settings{.num_disparities = 3,
                       .cost = MatchCost::kAdCensus,
                       .census = CensusPattern::k5x5,
                       .ad_limit = 16,
                       .outside_cost = 9};
  const std::vector<int> full = CostsAt(left_, right_, settings, 3, 0);
  settings.ad_limit = 3;
  const std::vector<int> limited = CostsAt(left_, right_, settings, 3, 0);
  settings.cost = MatchCost::kCensus;
  const std::vector<int> census = CostsAt(left_, right_, settings, 3, 0);
  // (80 + 2) >> 2 = 20 against (100 + 2) >> 2 = 25, (160 + 2) >> 2 = 40, 20.
  EXPECT_THAT((std::vector{full[0] - census[0], full[1] - census[1], full[2] - census[2]}),
              ElementsAre(5, 16, 0));
  EXPECT_THAT((std::vector{limited[0] - census[0], limited[1] - census[1], limited[2] - census[2]}),
              ElementsAre(3, 3, 0));
}

TEST_F(PixelCostTest, CensusCountsDifferingNeighboursAndHalvesLongCodes) {
  SgmSettings settings{.num_disparities = 1, .cost = MatchCost::kCensus};
  // One row, so each neighbour column counts once for each row of the window. Left x = 2 (40):
  // darker at -2, -1. Right x = 2 (160): darker at -2, -1, +1, +2. Columns +1, +2 differ.
  settings.census = CensusPattern::k5x5;
  EXPECT_THAT(CostsAt(left_, right_, settings, 2, 0), ElementsAre(2 * 5));
  // 7 x 7: x = -1 repeats x = 0, so -3 is as -2; +3 darker in the right only: 3 * 7 = 21 bits.
  settings.census = CensusPattern::k7x7;
  EXPECT_THAT(CostsAt(left_, right_, settings, 2, 0), ElementsAre((21 + 1) / 2));
}

TEST(OutsideCost, FitsTheCostUnlessItIsGiven) {
  SgmSettings settings;
  EXPECT_EQ(OutsideCost(settings), 9);
  settings.cost = MatchCost::kCensus;
  EXPECT_EQ(OutsideCost(settings), 7);
  settings.census = CensusPattern::k9x7;
  EXPECT_EQ(OutsideCost(settings), 9);
  settings.cost = MatchCost::kSad;
  EXPECT_EQ(OutsideCost(settings), 6);
  settings.grey_limit = 31;
  EXPECT_EQ(OutsideCost(settings), 3);
  settings.outside_cost = 0;
  EXPECT_EQ(OutsideCost(settings), 0);
}

}  // namespace
}  // namespace vs
