#include "engine/image/resample.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

namespace vs {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;

class ResampleTest : public testing::Test {
 protected:
  // A picture of one row, resampled to `width`.
  std::vector<int> Line(const std::vector<int>& pixels, int width) {
    GreyImage image(pool_, static_cast<int>(pixels.size()), 1);
    for (size_t x = 0; x < pixels.size(); ++x) image.Row(0)[x] = static_cast<uint8_t>(pixels[x]);
    const GreyImage line = Resample(image, width, 1, pool_);
    return {line.Row(0), line.Row(0) + width};
  }
  // The same numbers as a column.
  std::vector<int> Column(const std::vector<int>& pixels, int height) {
    GreyImage image(pool_, 1, static_cast<int>(pixels.size()));
    for (size_t y = 0; y < pixels.size(); ++y) {
      image.Row(static_cast<int>(y))[0] = static_cast<uint8_t>(pixels[y]);
    }
    const GreyImage resampled = Resample(image, 1, height, pool_);
    std::vector<int> column;
    column.reserve(static_cast<size_t>(height));
    for (int y = 0; y < height; ++y) column.push_back(resampled.Row(y)[0]);
    return column;
  }

  BufferPool pool_;
};

TEST_F(ResampleTest, ShrinkingAveragesWhatAPixelCovers) {
  EXPECT_THAT(Line({10, 20, 30, 50, 255, 254}, 3), ElementsAre(15, 40, 255));  // 254.5 rounds up
  // Two pixels from three: the middle one counts half for each, (60 + 90 / 2) / 1.5 = 70.
  EXPECT_THAT(Line({60, 90, 30}, 2), ElementsAre(70, 50));
  EXPECT_THAT(Line({1, 2, 3, 4, 5, 6, 7}, 1), ElementsAre(4));
}

TEST_F(ResampleTest, GrowingInterpolatesBetweenCentres) {
  // The new centres lie a quarter of a pixel beside the old ones; none lies beyond the border.
  EXPECT_THAT(Line({0, 100, 200}, 6), ElementsAre(0, 25, 75, 125, 175, 200));
  EXPECT_THAT(Line({7}, 3), Each(7));
}

TEST_F(ResampleTest, TreatsBothAxesAlike) {
  EXPECT_EQ(Column({60, 90, 30}, 2), Line({60, 90, 30}, 2));
  EXPECT_EQ(Column({0, 100, 200}, 6), Line({0, 100, 200}, 6));
}

TEST_F(ResampleTest, KeepsAUniformPictureUniformAtAnySize) {
  GreyImage white(pool_, 37, 23);
  white.Fill(255);
  for (const int size : {1, 2, 5, 22, 23, 24, 36, 37, 38, 100}) {
    const GreyImage resampled = Resample(white, size, 101 - size, pool_);
    for (int y = 0; y < resampled.height(); ++y) {
      for (int x = 0; x < size; ++x) ASSERT_EQ(resampled.Row(y)[x], 255) << size;
    }
  }
}

TEST_F(ResampleTest, LeavesAPictureOfTheSameSizeAsItIs) {
  EXPECT_THAT(Line({3, 1, 4, 1, 5, 9}, 6), ElementsAre(3, 1, 4, 1, 5, 9));
}

TEST_F(ResampleTest, HalvedIsTheMeanOfFourAndLeavesOutTheRest) {
  GreyImage image(pool_, 5, 5);
  for (int y = 0; y < 5; ++y) {
    for (int x = 0; x < 5; ++x) image.Row(y)[x] = static_cast<uint8_t>(y * 50 + x);
  }
  image.Row(0)[0] = 3;  // (3 + 1 + 50 + 51 + 2) / 4
  const GreyImage halved = Halved(image, pool_);
  ASSERT_EQ(halved.width(), 2);
  ASSERT_EQ(halved.height(), 2);
  EXPECT_EQ(halved.Row(0)[0], 26);
  EXPECT_EQ(halved.Row(0)[1], 28);
  EXPECT_EQ(halved.Row(1)[0], 126);
  EXPECT_EQ(halved.Row(1)[1], 128);
}

}  // namespace
}  // namespace vs
