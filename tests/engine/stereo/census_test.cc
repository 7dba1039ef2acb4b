#include "engine/stereo/census.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <numeric>
#include <vector>

#include "tests/engine/stereo/pictures.h"

namespace vs {
namespace {

using testing::Each;
using testing::ElementsAre;

// Darker neighbours of each pixel of row y.
std::vector<int> BitCounts(const GreyImage& image, CensusPattern pattern, int y) {
  PaddedPicture picture;
  picture.Assign(image, 0);
  const auto width = static_cast<size_t>(image.width());
  std::vector<uint8_t> codes(width * CensusBytes(pattern), 0xee);
  CensusRow(picture, pattern, y, codes.data());
  std::vector<int> counts(width, 0);
  for (size_t k = 0; k < codes.size(); ++k) counts[k % width] += std::popcount(codes[k]);
  return counts;
}

TEST(Census, ComparesEveryNeighbourOfItsPatternOnce) {
  BufferPool pool;
  GreyImage image(pool, 16, 16);
  image.Fill(10);
  image.Row(8)[8] = 20;  // brighter than all its neighbours
  const auto count_at_centre = [&](CensusPattern pattern) {
    return BitCounts(image, pattern, 8)[8];
  };
  EXPECT_EQ(count_at_centre(CensusPattern::k5x5), 24);
  EXPECT_EQ(count_at_centre(CensusPattern::k7x7), 48);
  EXPECT_EQ(count_at_centre(CensusPattern::k9x7), 62);
  EXPECT_EQ(count_at_centre(CensusPattern::kStrided3x3), 24);
}

TEST(Census, SeesADarkPixelFromExactlyThePlacesOfItsPattern) {
  BufferPool pool;
  GreyImage image(pool, 16, 16);
  image.Fill(10);
  image.Row(8)[8] = 5;
  const auto row = [&](CensusPattern pattern, int y) { return BitCounts(image, pattern, y); };
  EXPECT_THAT(row(CensusPattern::k5x5, 8),
              ElementsAre(0, 0, 0, 0, 0, 0, 1, 1, 0, 1, 1, 0, 0, 0, 0, 0));
  EXPECT_THAT(row(CensusPattern::k5x5, 6),
              ElementsAre(0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 0, 0, 0, 0, 0));
  EXPECT_THAT(row(CensusPattern::k5x5, 5), Each(0));
  EXPECT_THAT(row(CensusPattern::k9x7, 5),
              ElementsAre(0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1, 1, 0, 0, 0));
  EXPECT_THAT(row(CensusPattern::k9x7, 4), Each(0));
  // Distances 1, 2, 3 in eight directions: from row 6 (two up) only -2, 0, 2.
  EXPECT_THAT(row(CensusPattern::kStrided3x3, 6),
              ElementsAre(0, 0, 0, 0, 0, 0, 1, 0, 1, 0, 1, 0, 0, 0, 0, 0));
  EXPECT_THAT(row(CensusPattern::kStrided3x3, 8),
              ElementsAre(0, 0, 0, 0, 0, 1, 1, 1, 0, 1, 1, 1, 0, 0, 0, 0));
}

TEST(Census, TakesAnEqualNeighbourForNotDarkerAndRepeatsTheBorder) {
  BufferPool pool;
  GreyImage image(pool, 16, 16);
  image.Fill(0);
  EXPECT_THAT(BitCounts(image, CensusPattern::k5x5, 0), Each(0));
  image.Row(0)[0] = 1;  // of its 5 x 5 neighbours, the 8 up and left of it are itself
  EXPECT_EQ(BitCounts(image, CensusPattern::k5x5, 0)[0], 16);
}

TEST(PaddedPicture, ComputesClippedGradientsAboutTheCap) {
  BufferPool pool;
  GreyImage image(pool, 16, 16);
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 16; ++x) image.Row(y)[x] = static_cast<uint8_t>(x < 8 ? 10 : 11 + x);
  }
  PaddedPicture picture;
  picture.Assign(image, 31);
  // Weights 1, 2, 1 on a step: 4 * (19 - 10) = 36, clipped to 31; 4 * 2 = 8 on the ramp, 4 at the
  // border, where the picture goes on with its last column.
  EXPECT_EQ(picture.Row(8)[4], 31);
  EXPECT_EQ(picture.Row(8)[7], 31 + 31);
  EXPECT_EQ(picture.Row(8)[12], 31 + 8);
  EXPECT_EQ(picture.Row(8)[15], 31 + 4);
  EXPECT_EQ(picture.Row(8)[18], 31 + 4) << "padding repeats the gradient picture's border";
}

}  // namespace
}  // namespace vs
