#include "engine/stereo/condition_pair.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "tests/engine/stereo/pictures.h"

namespace vs {
namespace {

class ConditionPairTest : public testing::Test {
 protected:
  // A picture of grey(x, y), rounded, with normally distributed noise.
  GreyImage Picture(double sigma, const std::function<double(int, int)>& grey, int width = 320,
                    int height = 240) {
    std::normal_distribution<double> noise(0, 1);
    GreyImage picture(pool_, width, height);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const double value = grey(x, y) + sigma * noise(random_);
        picture.Row(y)[x] = static_cast<uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
      }
    }
    return picture;
  }
  // Smooth surfaces, some hard edges, and finely textured patches.
  static double Scene(int x, int y) {
    const double surface = 60 + 0.2 * x + 0.1 * y + (x / 80 % 2 == 0 ? 40 : 0);
    return x / 40 % 4 == 1 && y / 40 % 2 == 0 ? surface + (x * 7 + y * 13) % 31 : surface;
  }

  std::mt19937 random_{1};
  BufferPool pool_;
};

TEST_F(ConditionPairTest, NoiseIsFoundBetweenEdgesAndTexture) {
  for (const double sigma : {1.0, 2.0, 3.0, 5.0}) {
    EXPECT_NEAR(sigma, NoiseSixteenths(Picture(sigma, Scene)) / 16.0, 0.15 * sigma) << sigma;
  }
  EXPECT_LT(NoiseSixteenths(Picture(0, Scene)), 8);
}

TEST_F(ConditionPairTest, NoiseThatIsCutOffDoesNotCount) {
  // Two thirds of the picture are black or white; what is left has noise of 3 grey levels.
  const auto third = [](int x, int) { return x < 100 ? 0.0 : x < 200 ? 255.0 : 120.0; };
  EXPECT_NEAR(3.0, NoiseSixteenths(Picture(3, third)) / 16.0, 0.45);
  EXPECT_EQ(0, NoiseSixteenths(Picture(3, [](int, int) { return 255.0; })));
}

TEST_F(ConditionPairTest, TheSmallestAndALargePictureHaveANoiseEstimate) {
  EXPECT_NEAR(2.0, NoiseSixteenths(Picture(2, Scene, 16, 16)) / 16.0, 1.0);
  EXPECT_NEAR(2.0, NoiseSixteenths(Picture(2, Scene, 2048, 1536)) / 16.0, 0.3);
}

TEST_F(ConditionPairTest, CleanAndEquallyBrightPicturesAreNotTouched) {
  const GreyImage left = Picture(1, Scene);
  const GreyImage right = Picture(1, Scene);
  const PicturePair pair = ConditionPair(left, right, {}, pool_);
  EXPECT_EQ(left.buffer().data, pair.left.buffer().data);
  EXPECT_EQ(right.buffer().data, pair.right.buffer().data);
}

TEST_F(ConditionPairTest, NoisyPicturesAreSmoothedUnlessThatIsSwitchedOff) {
  const GreyImage left = Picture(3, Scene);
  const GreyImage right = Picture(3, Scene);
  SgmSettings settings;
  const PicturePair smooth = ConditionPair(left, right, settings, pool_);
  EXPECT_LT(NoiseSixteenths(smooth.left), NoiseSixteenths(left) / 2);
  EXPECT_LT(NoiseSixteenths(smooth.right), NoiseSixteenths(right) / 2);
  settings.pre_blur = PreBlur::kStrong;
  EXPECT_EQ(RowsOf(smooth.left), RowsOf(ConditionPair(left, right, settings, pool_).left));
  settings.pre_blur = PreBlur::kOff;
  EXPECT_EQ(RowsOf(left), RowsOf(ConditionPair(left, right, settings, pool_).left));
}

TEST_F(ConditionPairTest, SmoothingKeepsFlatAreasAndTheBorder) {
  SgmSettings settings;
  settings.match_gain = false;
  for (const PreBlur blur : {PreBlur::kLight, PreBlur::kStrong}) {
    settings.pre_blur = blur;
    for (const int grey : {0, 1, 127, 255}) {
      const auto same = [&](int, int) { return static_cast<double>(grey); };
      const GreyImage flat = Picture(0, same, 17, 16);
      EXPECT_EQ(RowsOf(flat), RowsOf(ConditionPair(flat, flat, settings, pool_).right)) << grey;
    }
  }
}

TEST_F(ConditionPairTest, SmoothingSpreadsAPointLikeAGaussian) {
  const auto bright = [](int x, int y) { return x == 8 && y == 7 ? 255.0 : 0.0; };
  const GreyImage point = Picture(0, bright, 17, 16);
  SgmSettings settings;
  settings.match_gain = false;
  settings.pre_blur = PreBlur::kStrong;
  const GreyImage smooth = ConditionPair(point, point, settings, pool_).left;
  const double side = std::exp(-1 / (2 * 0.7 * 0.7));  // sigma 0.7 px
  const double sum = 1 + 2 * side;
  EXPECT_NEAR(255 / (sum * sum), smooth.Row(7)[8], 2);
  EXPECT_NEAR(255 * side / (sum * sum), smooth.Row(7)[9], 2);
  EXPECT_NEAR(255 * side / (sum * sum), smooth.Row(6)[8], 2);
  EXPECT_NEAR(255 * side * side / (sum * sum), smooth.Row(8)[7], 2);
  EXPECT_EQ(0, smooth.Row(7)[10]);
}

TEST_F(ConditionPairTest, TheRightPictureGetsTheBrightnessAndContrastOfTheLeft) {
  const GreyImage left = Picture(1, Scene);
  const GreyImage right = Picture(1, [](int x, int y) { return 0.8 * Scene(x, y) + 5; });
  SgmSettings settings;
  settings.num_disparities = 1;
  const GreyMap map = MatchGreys(left, right, settings);
  EXPECT_NEAR(1 / 0.8, static_cast<double>(map.gain) / GreyMap::kOne, 0.03);
  EXPECT_NEAR(-5 / 0.8, static_cast<double>(map.offset) / GreyMap::kOne, 3);
  const PicturePair pair = ConditionPair(left, right, settings, pool_);
  EXPECT_EQ(left.buffer().data, pair.left.buffer().data);
  double difference = 0;
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 320; ++x) {
      difference += std::abs(pair.left.Row(y)[x] - pair.right.Row(y)[x]) / (320.0 * 240);
    }
  }
  EXPECT_LT(difference, 2.0);
  settings.match_gain = false;
  EXPECT_EQ(RowsOf(right), RowsOf(ConditionPair(left, right, settings, pool_).right));
}

TEST_F(ConditionPairTest, WhatOnlyOneCameraSeesDoesNotCountAsBrightness) {
  // The bright strip on the left is outside of the right view at a disparity of 64.
  const auto scene = [](int x, int y) { return x < 64 ? 250.0 : 40 + (x * 5 + y * 3) % 120; };
  const GreyImage left = Picture(0, scene);
  const GreyImage right = Picture(0, [&](int x, int y) { return scene(x + 64, y); });
  SgmSettings settings;
  settings.num_disparities = 128;
  EXPECT_EQ(GreyMap{}, MatchGreys(left, right, settings));
  settings.num_disparities = 1;  // at infinity both would see it
  EXPECT_NE(GreyMap{}, MatchGreys(left, right, settings));
}

TEST_F(ConditionPairTest, PicturesThatCannotBeComparedKeepTheirGreys) {
  SgmSettings settings;
  settings.num_disparities = 1;
  const GreyImage left = Picture(1, Scene);
  const GreyImage flat = Picture(0, [](int, int) { return 90.0; });
  const GreyImage faint = Picture(0, [](int x, int y) { return 20 + 0.3 * Scene(x, y); });
  EXPECT_EQ(GreyMap{}, MatchGreys(left, flat, settings));
  EXPECT_EQ(GreyMap{}, MatchGreys(left, faint, settings));
  settings.min_disparity = 2000;  // the views have nothing in common
  const GreyImage dark = Picture(1, [](int x, int y) { return 0.7 * Scene(x, y); });
  EXPECT_NE(GreyMap{}, MatchGreys(left, dark, settings));
}

}  // namespace
}  // namespace vs
