#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "engine/stereo/background_fill.h"
#include "engine/stereo/gated_filter.h"
#include "engine/stereo/left_right_check.h"
#include "engine/stereo/median_filter.h"
#include "engine/stereo/speckle_filter.h"
#include "tests/engine/stereo/pictures.h"

namespace vs {
namespace {

using testing::ElementsAre;

constexpr auto kNone = static_cast<uint8_t>(InvalidReason::kNone);

class Filters : public testing::Test {
 protected:
  DisparityMap Median(const DisparityMap& map, int size) {
    DisparityMap out = EmptyLike(pool_, map);
    MedianFilterRows(map, size, 0, map.disparity.height(), &scratch_, &out);
    return out;
  }
  DisparityMap Gated(const DisparityMap& map, const GreyImage& grey,
                     const GatedFilterOptions& options) {
    DisparityMap out = EmptyLike(pool_, map);
    GatedFilterRows(map, grey, options, 0, map.disparity.height(), &gated_, &out);
    return out;
  }
  GreyImage Grey(int width, int height, uint8_t value) {
    GreyImage image(pool_, width, height);
    image.Fill(value);
    return image;
  }
  DisparityMap Even(int width, int height, uint16_t value) {
    Image<uint16_t> disparity(pool_, width, height);
    disparity.Fill(value);
    return MakeMap(pool_, disparity);
  }

  BufferPool pool_;
  std::vector<uint16_t> scratch_;
  GatedFilterScratch gated_;
};

TEST_F(Filters, MedianRemovesALoneValueAndClosesALoneHole) {
  const DisparityMap map = MakeMap(pool_, {{160, 160, 160, 160, 0},
                                           {160, 900, 160, 0, 0},
                                           {160, 160, 160, 0, 80},
                                           {0, 160, 160, 0, 0}});
  const DisparityMap out = Median(map, 3);
  EXPECT_THAT(RowsOf(out.disparity),
              ElementsAre(ElementsAre(160, 160, 160, 160, 0), ElementsAre(160, 160, 160, 80, 0),
                          ElementsAre(160, 160, 160, 0, 0), ElementsAre(160, 160, 160, 0, 0)));
  EXPECT_EQ(out.confidence.Row(1)[1], 200) << "a measured pixel keeps its confidence";
  EXPECT_EQ(out.confidence.Row(3)[0], kFilledConfidence);
  EXPECT_EQ(out.reason.Row(3)[0], kNone);
  EXPECT_EQ(out.confidence.Row(2)[4], 0);
  EXPECT_EQ(out.reason.Row(2)[4], static_cast<uint8_t>(InvalidReason::kFiltered));
  EXPECT_EQ(out.reason.Row(0)[4], static_cast<uint8_t>(InvalidReason::kOccluded));
}

TEST_F(Filters, MedianOf5x5NeedsMoreThanTwelveNeighbours) {
  Image<uint16_t> disparity(pool_, 9, 9);
  disparity.Fill(100);
  for (int y = 3; y < 6; ++y) {
    for (int x = 3; x < 6; ++x) disparity.Row(y)[x] = 400;
  }
  const DisparityMap map = MakeMap(pool_, disparity);
  EXPECT_EQ(Median(map, 3).disparity.Row(4)[4], 400);
  EXPECT_EQ(Median(map, 5).disparity.Row(4)[4], 100);
}

TEST_F(Filters, GatedMedianLooksOnlyAtSimilarGrey) {
  // Two surfaces at disparities 100 and 300 that grey tells apart; the first column of the right
  // one went with the left one.
  Image<uint16_t> disparity(pool_, 8, 6);
  GreyImage grey(pool_, 8, 6);
  for (int y = 0; y < 6; ++y) {
    for (int x = 0; x < 8; ++x) {
      disparity.Row(y)[x] = x < 5 ? 100 : 300;
      grey.Row(y)[x] = x < 4 ? 50 : 80;
    }
  }
  const DisparityMap map = MakeMap(pool_, disparity);
  const auto at_edge = [&](const GatedFilterOptions& options) {
    return Gated(map, grey, options).disparity.Row(2)[4];
  };
  EXPECT_EQ(at_edge({.gate = 29, .fill = false}), 300) << "10 of the 15 alike";
  EXPECT_EQ(at_edge({.gate = 30, .fill = false}), 100) << "15 of all 25";
  EXPECT_EQ(at_edge({.gate = 29, .median = false, .fill = false}), 100);
}

TEST_F(Filters, GatedMedianOfAnEvenNumberTakesTheUpperMiddle) {
  DisparityMap map = MakeMap(pool_, {{10, 20, 30, 40}});
  const GreyImage grey = MakeImage<uint8_t>(pool_, {{9, 9, 200, 9}});
  // x = 0 sees 10 and 20 (30 is of other grey); x = 1 sees 10, 20 and 40.
  EXPECT_THAT(RowsOf(Gated(map, grey, {.gate = 0, .fill = false}).disparity),
              ElementsAre(ElementsAre(20, 20, 30, 40)));
}

TEST_F(Filters, AHoleIsFilledFromNeighboursThatAgree) {
  DisparityMap map = Even(9, 9, 320);
  map.disparity.Row(4)[4] = kInvalidDisparity;
  const DisparityMap out = Gated(map, Grey(9, 9, 60), {});
  EXPECT_EQ(out.disparity.Row(4)[4], 320);
  EXPECT_EQ(out.confidence.Row(4)[4], kFilledConfidence);
  EXPECT_EQ(out.reason.Row(4)[4], kNone);
}

TEST_F(Filters, AHoleStaysWhereNeighboursAreFewOrDisagree) {
  DisparityMap few =
      MakeMap(pool_, {{320, 320, 320, 320}, {320, 0, 320, 320}, {320, 320, 320, 320}});
  EXPECT_EQ(Gated(few, Grey(4, 3, 60), {}).disparity.Row(1)[1], kInvalidDisparity) << "11 members";
  few = MakeMap(pool_, {{320, 320, 320, 320, 320}, {320, 0, 320, 320, 0}, {320, 320, 320, 320, 0}});
  EXPECT_EQ(Gated(few, Grey(5, 3, 60), {}).disparity.Row(1)[1], 320) << "12 members";

  Image<uint16_t> disparity(pool_, 7, 7);  // 48 members, 15 of them a pixel and a bit away
  disparity.Fill(320);
  for (int k = 0; k < 15; ++k) disparity.Row(k / 7)[k % 7] = 320 + 17;
  disparity.Row(3)[3] = kInvalidDisparity;
  const DisparityMap split = MakeMap(pool_, disparity);
  EXPECT_EQ(Gated(split, Grey(7, 7, 60), {.median = false}).disparity.Row(3)[3], kInvalidDisparity)
      << "33 of 48 are 68.75 %";
  disparity.Row(0)[0] = 320 + 16;
  EXPECT_EQ(Gated(MakeMap(pool_, disparity), Grey(7, 7, 60), {.median = false}).disparity.Row(3)[3],
            320)
      << "34 of 48 are 70.8 %";
}

TEST_F(Filters, BackgroundFillTakesTheFartherSide) {
  DisparityMap map = MakeMap(pool_, {{0, 48, 0, 0, 32, 0}, {0, 0, 0, 0, 0, 0}});
  FillBackgroundRows(0, 2, &map);
  EXPECT_THAT(RowsOf(map.disparity),
              ElementsAre(ElementsAre(48, 48, 32, 32, 32, 32), ElementsAre(0, 0, 0, 0, 0, 0)));
  EXPECT_EQ(map.confidence.Row(0)[2], kFilledConfidence);
  EXPECT_EQ(map.reason.Row(0)[2], kNone);
  EXPECT_EQ(map.reason.Row(1)[2], static_cast<uint8_t>(InvalidReason::kOccluded));
}

TEST_F(Filters, SpecklesAreRegionsUpToTheirSize) {
  DisparityMap map = MakeMap(
      pool_,
      {{100, 100, 0, 300, 300}, {100, 116, 0, 0, 300}, {0, 0, 200, 0, 0}, {500, 0, 217, 234, 0}});
  RemoveSpeckles(3, 16, pool_, &map);
  // The region of 100s joins 116 (a step of 16) and has 4 pixels; 200, 217 and 234 are 17 apart.
  EXPECT_THAT(RowsOf(map.disparity),
              ElementsAre(ElementsAre(100, 100, 0, 0, 0), ElementsAre(100, 116, 0, 0, 0),
                          ElementsAre(0, 0, 0, 0, 0), ElementsAre(0, 0, 0, 0, 0)));
  EXPECT_EQ(map.reason.Row(0)[3], static_cast<uint8_t>(InvalidReason::kSpeckle));
  EXPECT_EQ(map.confidence.Row(0)[3], 0);
  EXPECT_EQ(map.reason.Row(0)[2], static_cast<uint8_t>(InvalidReason::kOccluded));
  EXPECT_EQ(map.confidence.Row(0)[0], 200);
}

TEST_F(Filters, ARegionMayWindAboutAnother) {
  DisparityMap map = MakeMap(pool_, {{10, 10, 10, 10, 10},
                                     {90, 90, 90, 90, 10},
                                     {10, 10, 10, 90, 10},
                                     {10, 90, 90, 90, 10},
                                     {10, 10, 10, 10, 10}});
  RemoveSpeckles(8, 1, pool_, &map);
  EXPECT_THAT(RowsOf(map.disparity),
              ElementsAre(ElementsAre(10, 10, 10, 10, 10), ElementsAre(0, 0, 0, 0, 10),
                          ElementsAre(10, 10, 10, 0, 10), ElementsAre(10, 0, 0, 0, 10),
                          ElementsAre(10, 10, 10, 10, 10)));
}

TEST_F(Filters, LeftRightCheckKeepsWhatBothViewsSay) {
  // Left x = 4 at 2 px points to right x = 2; x = 5 at 2.5 px rounds to right x = 3 (2.5 -> 3).
  const DisparityMap left = MakeMap(pool_, {{16, 0, 0, 0, 32, 40, 32, 48}});
  const DisparityMap right = MakeMap(pool_, {{0, 0, 32, 40, 0, 0, 0, 0}});
  auto checked = CheckLeftRight(left, right, 0, pool_);
  ASSERT_TRUE(checked.has_value());
  EXPECT_THAT(RowsOf(checked->disparity), ElementsAre(ElementsAre(0, 0, 0, 0, 32, 40, 0, 0)));
  const auto reason = [&](int x) { return static_cast<InvalidReason>(checked->reason.Row(0)[x]); };
  EXPECT_EQ(reason(0), InvalidReason::kBorder);
  EXPECT_EQ(reason(6), InvalidReason::kOccluded) << "the right view knows nothing there";
  EXPECT_EQ(checked->confidence.Row(0)[4], 200);
}

TEST_F(Filters, LeftRightCheckToleratesUpToItsDifference) {
  const DisparityMap left = MakeMap(pool_, {{0, 0, 0, 0, 32, 32, 0, 0}});
  const DisparityMap right = MakeMap(pool_, {{0, 0, 48, 49, 0, 0, 0, 0}});
  auto checked = CheckLeftRight(left, right, 1, pool_);
  ASSERT_TRUE(checked.has_value());
  EXPECT_THAT(RowsOf(checked->disparity), ElementsAre(ElementsAre(0, 0, 0, 0, 32, 0, 0, 0)));
}

TEST_F(Filters, LeftRightCheckNeedsMapsOfOneSize) {
  const auto checked = CheckLeftRight(Even(8, 4, 16), Even(8, 5, 16), 1, pool_);
  ASSERT_FALSE(checked.has_value());
  EXPECT_EQ(checked.error().code(), StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace vs
