#include "engine/stereo/cost_window.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "tests/engine/stereo/pictures.h"

namespace vs {
namespace {

using testing::ElementsAre;

// Costs of disparity 0 of one row, for pictures that differ by `costs`.
std::vector<int> CostRow(const GreyImage& costs, const GreyImage& guide, SgmSettings settings,
                         int y) {
  settings.num_disparities = 1;
  settings.cost = MatchCost::kSad;
  BufferPool pool;
  GreyImage zero(pool, costs.width(), costs.height());
  zero.Fill(0);
  PaddedPicture left;
  PaddedPicture right;
  left.Assign(costs, 0);
  right.Assign(zero, 0);
  CostRows rows;
  rows.Prepare(&left, &right, &guide, settings);
  std::vector<uint8_t> row(static_cast<size_t>(costs.width()));
  rows.Row(y, row.data());
  return {row.begin(), row.end()};
}

class CostWindow : public testing::Test {
 protected:
  BufferPool pool_;
  const GreyImage costs_ = MakeImage<uint8_t>(pool_, {{0, 0, 0, 0, 0},  //
                                                      {0, 0, 60, 0, 0},
                                                      {0, 0, 0, 0, 0},
                                                      {30, 0, 0, 0, 0}});
  const GreyImage even_ = MakeImage<uint8_t>(
      pool_,
      {{90, 90, 90, 90, 90}, {90, 90, 90, 90, 90}, {90, 90, 90, 90, 90}, {90, 90, 90, 90, 90}});
};

TEST_F(CostWindow, AveragesOverTheWindowWithRounding) {
  const SgmSettings settings{.window_width = 3, .window_height = 3, .smooth_cost = false};
  // 60 / 9 = 6.67 -> 7
  EXPECT_THAT(CostRow(costs_, even_, settings, 0), ElementsAre(0, 7, 7, 7, 0));
  // Row 2, x = 0: the 30 below counts for columns -1 and 0: 60 / 9; x = 1: 30 / 9 + 60 / 9 = 10.
  EXPECT_THAT(CostRow(costs_, even_, settings, 2), ElementsAre(7, 10, 7, 7, 0));
  // Row 3, x = 0: rows 3 and 4 (repeated): 4 * 30 / 9 = 13.3.
  EXPECT_THAT(CostRow(costs_, even_, settings, 3), ElementsAre(13, 7, 0, 0, 0));
}

TEST_F(CostWindow, AnEvenWindowReachesFartherBack) {
  const SgmSettings settings{.window_width = 2, .window_height = 1, .smooth_cost = false};
  EXPECT_THAT(CostRow(costs_, even_, settings, 1), ElementsAre(0, 0, 30, 30, 0));
}

TEST_F(CostWindow, SmoothingIsBinomialOnAnEvenPicture) {
  const SgmSettings settings{.smooth_cost = true};
  // Across: 60 -> avg(60, 0) = 30 in the middle, avg(0, avg(60, 0)) = 15 beside. Down: halves.
  EXPECT_THAT(CostRow(costs_, even_, settings, 1), ElementsAre(0, 8, 15, 8, 0));
  // One row away: avg(0, avg(0, 30)) = 8; avg(0, avg(0, 15)) = 4.
  EXPECT_THAT(CostRow(costs_, even_, settings, 0), ElementsAre(0, 4, 8, 4, 0));
}

TEST_F(CostWindow, SmoothingStopsAtEdges) {
  const GreyImage edge = MakeImage<uint8_t>(
      pool_,
      {{90, 90, 90, 97, 97}, {90, 90, 90, 97, 97}, {97, 97, 97, 97, 97}, {97, 97, 97, 97, 97}});
  const SgmSettings settings{.smooth_cost = true, .smooth_cost_gate = 6};
  // Nothing crosses x = 2 | 3 or y = 1 | 2: across, the centre is averaged with itself on that
  // side, avg(60, avg(0, 60)) = 45; down, avg(45, avg(0, 45)) = 34.
  EXPECT_THAT(CostRow(costs_, edge, settings, 1), ElementsAre(0, 12, 34, 0, 0));
  // Row 3 across: avg(30, avg(30, 0)) = 23, avg(0, avg(30, 0)) = 8. Row 2 takes those from below
  // only: avg(0, avg(0, 23)) = 6, avg(0, avg(0, 8)) = 2.
  EXPECT_THAT(CostRow(costs_, edge, settings, 2), ElementsAre(6, 2, 0, 0, 0));
}

TEST_F(CostWindow, RowsMayBeAskedForInAnyOrder) {
  const SgmSettings settings{.num_disparities = 1,
                             .cost = MatchCost::kSad,
                             .window_width = 3,
                             .window_height = 3,
                             .smooth_cost = true};
  GreyImage zero(pool_, 5, 4);
  zero.Fill(0);
  PaddedPicture left;
  PaddedPicture right;
  left.Assign(costs_, 0);
  right.Assign(zero, 0);
  CostRows rows;
  rows.Prepare(&left, &right, &even_, settings);
  for (const int y : {3, 0, 2, 1, 1, 3, 0}) {
    std::vector<uint8_t> row(5);
    rows.Row(y, row.data());
    EXPECT_EQ((std::vector<int>(row.begin(), row.end())), CostRow(costs_, even_, settings, y)) << y;
  }
}

}  // namespace
}  // namespace vs
