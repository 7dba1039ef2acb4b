#include "engine/stereo/selection.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/engine/stereo/pictures.h"

namespace vs {
namespace {

using testing::ElementsAre;

// What the row kernel makes of one winner, in all places of a row.
struct Judged {
  int sixteenths;
  int confidence;
};
Judged JudgeOne(SubPixel method, uint8_t before, uint8_t best, uint8_t after, uint8_t second) {
  constexpr int kWidth = 37;
  std::vector<uint8_t> memory(size_t{kWidth} * WinnerRow::kPlanes);
  const WinnerRow winners = WinnerRow::In(memory.data(), kWidth);
  std::fill_n(winners.index, kWidth, uint8_t{2});
  std::fill_n(winners.best, kWidth, best);
  std::fill_n(winners.second, kWidth, second);
  std::fill_n(winners.before, kWidth, before);
  std::fill_n(winners.after, kWidth, after);
  const std::vector<uint8_t> greys(kWidth, 128);
  std::vector<uint16_t> disparity(kWidth);
  std::vector<uint8_t> confidence(kWidth);
  std::vector<uint8_t> reason(kWidth);
  PlainFilterKernels().judge(
      {.winners = winners,
       .left = {greys.data(), greys.data(), greys.data(), greys.data(), greys.data()},
       .width = kWidth,
       .min_disparity = -2,  // index 2: the counterpart is the pixel itself
       .last_index = 4,
       .first_stored = 160,
       .sub_pixel = method,
       .disparity = disparity.data(),
       .confidence = confidence.data(),
       .reason = reason.data()});
  EXPECT_THAT(reason, testing::Each(0));
  EXPECT_THAT(disparity, testing::Each(disparity[0]));
  EXPECT_THAT(confidence, testing::Each(confidence[0]));
  return {disparity[0] - 160 - 2 * 16, confidence[0]};
}
int Sixteenths(SubPixel method, uint8_t before, uint8_t best, uint8_t after) {
  return JudgeOne(method, before, best, after, 255).sixteenths;
}

TEST(SubPixel, EquiangularAndParabolaFindTheMinimum) {
  // Costs 10, 4, 6: equiangular 8 * 4 / 6 = 5.33, parabola 8 * 4 / 8 = 4.
  EXPECT_EQ(Sixteenths(SubPixel::kEquiangular, 10, 4, 6), 5);
  EXPECT_EQ(Sixteenths(SubPixel::kParabola, 10, 4, 6), 4);
  EXPECT_EQ(Sixteenths(SubPixel::kEquiangular, 6, 4, 10), -5);
  EXPECT_EQ(Sixteenths(SubPixel::kOff, 10, 4, 6), 0);
}

TEST(SubPixel, RoundsHalvesUpwards) {
  // 8 * 5 / 16 = 2.5 and 8 * -5 / 16 = -2.5.
  EXPECT_EQ(Sixteenths(SubPixel::kEquiangular, 16, 0, 11), 3);
  EXPECT_EQ(Sixteenths(SubPixel::kEquiangular, 11, 0, 16), -2);
}

TEST(SubPixel, StaysWithinHalfAPixel) {
  EXPECT_EQ(Sixteenths(SubPixel::kEquiangular, 255, 0, 0), 8);
  EXPECT_EQ(Sixteenths(SubPixel::kEquiangular, 0, 0, 255), -8);
  EXPECT_EQ(Sixteenths(SubPixel::kParabola, 7, 7, 7), 0);
}

TEST(SubPixel, EqualsTheDivisionOfIntegers) {
  for (int higher = 1; higher < 256; higher += 2) {
    for (int lower = 0; lower <= higher; ++lower) {
      const int expected = (16 * (higher - lower) + 17 * higher) / (2 * higher) - 8;
      ASSERT_EQ(Sixteenths(SubPixel::kEquiangular, static_cast<uint8_t>(higher), 0,
                           static_cast<uint8_t>(lower)),
                expected)
          << higher << " " << lower;
    }
  }
}

TEST(Confidence, EqualsTheDivisionOfIntegers) {
  for (int second = 0; second < 256; second += 3) {
    for (int best = 0; best <= second; ++best) {
      const int margin = second == 0 ? 0 : 255 * (second - best) / second;
      const int expected = std::max(margin, 2);
      ASSERT_EQ(JudgeOne(SubPixel::kOff, 255, static_cast<uint8_t>(best), 255,
                         static_cast<uint8_t>(second))
                    .confidence,
                expected)
          << second << " " << best;
    }
  }
}

// Runs the selection on a single row of 16 or more pixels.
class SelectionTest : public testing::Test {
 protected:
  void SetUp() override {
    settings_.num_disparities = 4;
    settings_.left_right_check = false;
    settings_.sub_pixel = SubPixel::kOff;
    sums_.assign(size_t{kWidth} * 4, 100);
    left_.Fill(50);
    for (int x = 0; x < kWidth; x += 2) left_.Row(0)[x] = 150;  // texture
  }
  uint8_t* Cell(int x) { return sums_.data() + static_cast<size_t>(x) * 4; }
  void Set(int x, std::initializer_list<uint8_t> sums) {
    std::copy(sums.begin(), sums.end(), Cell(x));
  }
  void Run() {
    Selection selection;
    selection.Prepare(settings_, kWidth);
    map_ = EmptyLike(pool_, MakeMap(pool_, Image<uint16_t>(pool_, kWidth, 1)));
    selection.Row({sums_.data(), kWidth, 1, 4}, left_, 0, &map_);
  }
  int Disparity(int x) const { return map_.disparity.Row(0)[x]; }
  int Confidence(int x) const { return map_.confidence.Row(0)[x]; }
  InvalidReason Reason(int x) const { return static_cast<InvalidReason>(map_.reason.Row(0)[x]); }

  static constexpr int kWidth = 16;
  BufferPool pool_;
  SgmSettings settings_;
  GreyImage left_{pool_, kWidth, 1};
  std::vector<uint8_t> sums_;
  DisparityMap map_;
};

TEST_F(SelectionTest, TakesTheLeastSumAndTheSmallerDisparityOfEquals) {
  Set(8, {90, 20, 70, 30});
  Set(9, {90, 20, 70, 20});
  Run();
  EXPECT_EQ(Disparity(8), 16 * 1);
  EXPECT_EQ(Disparity(9), 16 * 1);
}

TEST_F(SelectionTest, RefinesBetweenTheFirstAndLastDisparity) {
  settings_.sub_pixel = SubPixel::kEquiangular;
  Set(8, {90, 20, 60, 70});  // 8 * 30 / 70 = 3.4
  Set(9, {90, 60, 50, 20});
  Run();
  EXPECT_EQ(Disparity(8), 16 * 1 + 3);
  EXPECT_EQ(Disparity(9), 16 * 3);
}

TEST_F(SelectionTest, CallsDisparityZeroTooFar) {
  Set(8, {10, 90, 90, 90});
  Run();
  EXPECT_EQ(Disparity(8), kInvalidDisparity);
  EXPECT_EQ(Reason(8), InvalidReason::kOutOfRangeFar);
}

TEST_F(SelectionTest, KeepsEveryDisparityOfANegativeRange) {
  settings_.min_disparity = -2;
  Set(8, {10, 90, 90, 90});   // -2 px
  Set(9, {90, 90, 10, 90});   // 0 px
  Set(14, {10, 90, 90, 90});  // counterpart 16 is outside
  Run();
  EXPECT_EQ(DisparityOffset(settings_), -3);
  EXPECT_EQ(Disparity(8), 16 * 1);
  EXPECT_EQ(Disparity(9), 16 * 3);
  EXPECT_EQ(Reason(14), InvalidReason::kBorder);
}

TEST_F(SelectionTest, CallsACounterpartOutsideThePictureBorder) {
  Set(1, {90, 90, 10, 90});
  Set(2, {90, 90, 10, 90});
  Run();
  EXPECT_EQ(Reason(1), InvalidReason::kBorder);
  EXPECT_EQ(Reason(2), InvalidReason::kNone);
}

TEST_F(SelectionTest, ConfidenceIsTheMarginToTheBestOther) {
  Set(8, {80, 20, 21, 50});  // the best not next to the winner is 50: 255 * 30 / 50
  Set(9, {80, 20, 21, 20});  // 255 * 0 / 20, but at least 2
  Run();
  EXPECT_EQ(Confidence(8), 153);
  EXPECT_EQ(Confidence(9), 2);
  EXPECT_EQ(Confidence(0), 0) << "invalid";
}

TEST_F(SelectionTest, DropsPixelsBelowTheLeastConfidence) {
  settings_.min_confidence = 100;
  Set(8, {80, 20, 21, 50});
  Set(9, {80, 20, 21, 30});  // 255 * 10 / 30 = 85
  Run();
  EXPECT_EQ(Reason(8), InvalidReason::kNone);
  EXPECT_EQ(Reason(9), InvalidReason::kFiltered);
  EXPECT_EQ(Confidence(9), 0);
}

TEST_F(SelectionTest, UniquenessComparesWithDisparitiesThatAreNotNeighbours) {
  settings_.uniqueness_percent = 10;
  Set(8, {80, 90, 89, 100});   // 100 * 90 < 89 * 100 is false for the winner 80 (other: 89 -> 8010)
  Set(9, {80, 81, 100, 88});   // 88 * 90 = 7920 < 8000
  Set(10, {100, 90, 80, 81});  // only 100 is no neighbour
  Run();
  EXPECT_EQ(Reason(8), InvalidReason::kOutOfRangeFar) << "unique, but at disparity 0";
  EXPECT_EQ(Reason(10), InvalidReason::kNone);
  settings_.min_disparity = 1;
  Run();
  EXPECT_EQ(Reason(8), InvalidReason::kNone);
  EXPECT_EQ(Reason(9), InvalidReason::kAmbiguous);
}

// A surface at disparity 2 that covers the background at 1: its right pixels are taken.
TEST_F(SelectionTest, TheViewsMustAgree) {
  settings_.left_right_check = true;
  settings_.left_right_tolerance = 0;
  settings_.left_right_lenient = false;
  Set(8, {90, 30, 90, 90});   // right pixel 7, costs 30 there
  Set(9, {90, 90, 10, 90});   // right pixel 7 too, cheaper
  Set(12, {90, 90, 20, 90});  // right pixel 10, alone
  Run();
  EXPECT_EQ(Reason(8), InvalidReason::kOccluded);
  EXPECT_EQ(Reason(9), InvalidReason::kNone);
  EXPECT_EQ(Reason(12), InvalidReason::kNone);
  settings_.left_right_tolerance = 1;
  Run();
  EXPECT_EQ(Reason(8), InvalidReason::kNone);
}

TEST_F(SelectionTest, EachPixelOfDisagreementHalvesConfidence) {
  settings_.left_right_check = true;
  settings_.left_right_tolerance = 1;
  settings_.left_right_lenient = false;
  Set(8, {90, 30, 90, 90});  // 255 * 60 / 90 = 170
  Set(9, {90, 90, 10, 90});
  Run();
  EXPECT_EQ(Confidence(8), 85);
}

TEST_F(SelectionTest, LenientlyTheNeighbourOfTheCounterpartMayAgree) {
  settings_.left_right_check = true;
  settings_.left_right_tolerance = 0;
  settings_.left_right_lenient = true;
  Set(8, {90, 30, 90, 90});  // right pixel 7
  Set(9, {90, 90, 10, 90});  // takes right pixel 7 for disparity 2
  Set(7, {90, 40, 90, 90});  // right pixel 6 has disparity 1, as pixel 8
  Run();
  EXPECT_EQ(Reason(8), InvalidReason::kNone);
  settings_.left_right_lenient = false;
  Run();
  EXPECT_EQ(Reason(8), InvalidReason::kOccluded);
}

TEST_F(SelectionTest, DisagreementAtTheEndsOfTheRangeMeansOutOfRange) {
  settings_.left_right_check = true;
  settings_.left_right_tolerance = 0;
  settings_.left_right_lenient = false;
  settings_.min_disparity = 1;
  Set(9, {90, 90, 90, 30});   // d = 4, right pixel 5
  Set(7, {90, 10, 90, 90});   // d = 2, right pixel 5
  Set(12, {30, 90, 90, 90});  // d = 1, right pixel 11
  Set(14, {90, 90, 10, 90});  // d = 3, right pixel 11
  Run();
  EXPECT_EQ(Reason(9), InvalidReason::kOutOfRangeNear);
  EXPECT_EQ(Reason(12), InvalidReason::kOutOfRangeFar);
}

TEST_F(SelectionTest, ExplainsAFailureByWhatThePictureShows) {
  settings_.uniqueness_percent = 50;
  const auto ambiguous = {uint8_t{90}, uint8_t{20}, uint8_t{90}, uint8_t{21}};
  for (const int x : {3, 8, 13}) Set(x, ambiguous);
  left_.Row(0)[8] = 254;
  Run();
  EXPECT_EQ(Reason(3), InvalidReason::kAmbiguous);
  EXPECT_EQ(Reason(8), InvalidReason::kSaturated);
  left_.Row(0)[8] = 3;
  Run();
  EXPECT_EQ(Reason(8), InvalidReason::kDark);
  for (int x = 11; x <= 15; ++x) left_.Row(0)[x] = static_cast<uint8_t>(60 + x % 3);
  Run();
  EXPECT_EQ(Reason(13), InvalidReason::kLowTexture);
}

}  // namespace
}  // namespace vs
