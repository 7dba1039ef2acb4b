#include "engine/stereo/path_cost.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "tests/engine/stereo/pictures.h"

namespace vs {
namespace {

using testing::ElementsAre;

Penalties Constant(int p1, int p2) {
  return MakePenalties({.p1 = p1, .p2 = p2, .p2_min = p2, .p2_slope_permille = 0});
}

// Sums of one direction for a picture of even grey.
std::vector<uint8_t> SumsOf(Direction direction, const std::vector<uint8_t>& costs, int width,
                            int height, int disparities, const Penalties& penalties) {
  BufferPool pool;
  GreyImage guide(pool, width, height);
  guide.Fill(50);
  std::vector<uint8_t> copy = costs;
  std::vector<uint8_t> sums(costs.size(), 0);
  std::vector<uint8_t> scratch;
  AddPathCosts(direction, 0, LineCount(direction, width, height),
               {copy.data(), width, height, disparities}, guide, penalties, &scratch,
               {sums.data(), width, height, disparities});
  return sums;
}

TEST(PathCost, FollowsTheRecursionAlongARow) {
  // Three pixels of three disparities, P1 = 2, P2 = 5.
  const std::vector<uint8_t> costs = {0, 4, 9, 9, 3, 0, 7, 7, 7};
  // L1 = 0 4 9. T2 = 9 + 0, 3 + min(4, 0 + 2), 0 + min(9, 4 + 2, 5) = 9 5 5; L2 = 4 0 0.
  // T3 = 7 + min(4, 0 + 2), 7, 7; L3 = 2 0 0.
  EXPECT_THAT(SumsOf({1, 0}, costs, 3, 1, 3, Constant(2, 5)),
              ElementsAre(0, 4, 9, 4, 0, 0, 2, 0, 0));
}

TEST(PathCost, RunsBackwardsLikewise) {
  const std::vector<uint8_t> costs = {7, 7, 7, 9, 3, 0, 0, 4, 9};
  EXPECT_THAT(SumsOf({-1, 0}, costs, 3, 1, 3, Constant(2, 5)),
              ElementsAre(2, 0, 0, 4, 0, 0, 0, 4, 9));
}

TEST(PathCost, RunsDownAndUpLikewise) {
  const std::vector<uint8_t> costs = {0, 4, 9, 9, 3, 0, 7, 7, 7};
  EXPECT_THAT(SumsOf({0, 1}, costs, 1, 3, 3, Constant(2, 5)),
              ElementsAre(0, 4, 9, 4, 0, 0, 2, 0, 0));
  const std::vector<uint8_t> upside_down = {7, 7, 7, 9, 3, 0, 0, 4, 9};
  EXPECT_THAT(SumsOf({0, -1}, upside_down, 1, 3, 3, Constant(2, 5)),
              ElementsAre(2, 0, 0, 4, 0, 0, 0, 4, 9));
}

TEST(PathCost, ADiagonalStartsAnewWhereItEntersThePicture) {
  // 2 x 2 pixels of two disparities. Down to the right: (1, 1) follows (0, 0); the others start.
  const std::vector<uint8_t> costs = {0, 9, 6, 0, 3, 8, 5, 5};
  EXPECT_THAT(SumsOf({1, 1}, costs, 2, 2, 2, Constant(2, 5)),
              ElementsAre(0, 9, 6, 0, 0, 5, /* 5 + 0, 5 + 2 */ 0, 2));
  // Down to the left: (0, 1) follows (1, 0).
  EXPECT_THAT(SumsOf({-1, 1}, costs, 2, 2, 2, Constant(2, 5)),
              ElementsAre(0, 9, 6, 0, /* 3 + 2, 8 + 0 */ 0, 3, 0, 0));
}

TEST(PathCost, WithoutPenaltiesEachPixelStandsForItself) {
  const std::vector<uint8_t> costs = {5, 4, 9, 9, 3, 6};
  EXPECT_THAT(SumsOf({1, 0}, costs, 2, 1, 3, Constant(0, 0)), ElementsAre(1, 0, 5, 6, 0, 3));
}

TEST(PathCost, SumsSaturateAt255) {
  BufferPool pool;
  GreyImage guide(pool, 1, 1);
  guide.Fill(0);
  std::vector<uint8_t> costs = {0, 60};
  std::vector<uint8_t> sums = {0, 200};
  std::vector<uint8_t> scratch;
  AddPathCosts({1, 0}, 0, 1, {costs.data(), 1, 1, 2}, guide, Constant(1, 2), &scratch,
               {sums.data(), 1, 1, 2});
  EXPECT_THAT(sums, ElementsAre(0, 255));
}

TEST(PathCost, TakesTheGreyStepAlongThePath) {
  BufferPool pool;
  const GreyImage guide = MakeImage<uint8_t>(pool, {{10, 10, 110}});
  std::vector<uint8_t> costs = {0, 60, 60, 60, 60, 0, 60, 60, 0};
  std::vector<uint8_t> sums(9, 0);
  std::vector<uint8_t> scratch;
  // P2 is 40 without a step and 40 / (1 + 0.03 * 100) = 10 at the step of 100.
  const Penalties penalties =
      MakePenalties({.p1 = 5, .p2 = 40, .p2_min = 0, .p2_slope_permille = 30});
  AddPathCosts({1, 0}, 0, 1, {costs.data(), 3, 1, 3}, guide, penalties, &scratch,
               {sums.data(), 3, 1, 3});
  // L1 = 0 60 60. T2 = 60, 60 + 5, 0 + 40; L2 = 20 25 0. T3 = 60 + 10, 60 + 5, 0; L3 = 70 65 0.
  EXPECT_THAT(sums, ElementsAre(0, 60, 60, 20, 25, 0, 70, 65, 0));
}

TEST(Penalties, FallHyperbolicallyToTheirFloor) {
  const Penalties penalties = MakePenalties({.p2 = 34, .p2_slope_permille = 30});
  EXPECT_EQ(penalties.p1, 7);
  EXPECT_EQ(penalties.p2[0], 34);
  EXPECT_EQ(penalties.p2[1], 33);   // 34 / 1.03 = 33.01
  EXPECT_EQ(penalties.p2[10], 26);  // 34 / 1.3 = 26.15
  EXPECT_EQ(penalties.p2[40], 15);  // 34 / 2.2 = 15.45
  EXPECT_EQ(penalties.p2[60], 14);  // 34 / 2.8 = 12.1, but at least 14
  EXPECT_EQ(penalties.p2[255], 14);
}

TEST(Penalties, RoundHalvesUpAndStayBetweenP1AndP2) {
  EXPECT_EQ(MakePenalties({.p1 = 0, .p2 = 5, .p2_min = 0, .p2_slope_permille = 1000}).p2[1], 3);
  EXPECT_EQ(MakePenalties({.p1 = 9, .p2 = 12, .p2_min = 0, .p2_slope_permille = 1000}).p2[200], 9);
  EXPECT_EQ(MakePenalties({.p1 = 1, .p2 = 6, .p2_min = 50, .p2_slope_permille = 1000}).p2[200], 6);
  EXPECT_EQ(MakePenalties({.p1 = 0, .p2 = 0, .p2_min = 14}).p2[0], 0);
}

}  // namespace
}  // namespace vs
