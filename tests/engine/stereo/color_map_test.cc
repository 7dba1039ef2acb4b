#include "engine/stereo/color_map.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/engine/stereo/pictures.h"

namespace vs {

static void PrintTo(const Rgb& color, std::ostream* out) {
  *out << "(" << int{color.r} << ", " << int{color.g} << ", " << int{color.b} << ")";
}

namespace {

void ExpectNear(const Rgb& color, const Rgb& expected, int tolerance) {
  EXPECT_NEAR(color.r, expected.r, tolerance);
  EXPECT_NEAR(color.g, expected.g, tolerance);
  EXPECT_NEAR(color.b, expected.b, tolerance);
}

TEST(Palette, GreyIsLightWhereNear) {
  EXPECT_EQ(Palette(ColorMap::kGrey)[0], (Rgb{0, 0, 0}));
  EXPECT_EQ(Palette(ColorMap::kGrey)[100], (Rgb{100, 100, 100}));
  EXPECT_EQ(Palette(ColorMap::kGrey)[255], (Rgb{255, 255, 255}));
}

TEST(Palette, HueRunsFromRedToMagentaInFullColours) {
  const auto& hue = Palette(ColorMap::kHue);
  EXPECT_EQ(hue[0], (Rgb{255, 0, 0}));      // 0 degrees
  EXPECT_EQ(hue[51], (Rgb{255, 255, 0}));   // 60
  EXPECT_EQ(hue[102], (Rgb{0, 255, 0}));    // 120
  EXPECT_EQ(hue[153], (Rgb{0, 255, 255}));  // 180
  EXPECT_EQ(hue[204], (Rgb{0, 0, 255}));    // 240
  EXPECT_EQ(hue[255], (Rgb{255, 0, 255}));  // 300
  EXPECT_EQ(InvalidColor(ColorMap::kHue), (Rgb{255, 0, 0}));
}

// Colours of the published tables, between the samples that ours are drawn through.
TEST(Palette, TurboAndViridisFollowThePublishedTables) {
  EXPECT_EQ(Palette(ColorMap::kTurbo)[0], (Rgb{48, 18, 59}));
  ExpectNear(Palette(ColorMap::kTurbo)[64], {40, 188, 235}, 6);
  ExpectNear(Palette(ColorMap::kTurbo)[128], {164, 252, 60}, 6);
  ExpectNear(Palette(ColorMap::kTurbo)[192], {251, 126, 33}, 6);
  EXPECT_EQ(Palette(ColorMap::kTurbo)[255], (Rgb{122, 4, 3}));
  EXPECT_EQ(Palette(ColorMap::kViridis)[0], (Rgb{68, 1, 84}));
  ExpectNear(Palette(ColorMap::kViridis)[64], {59, 82, 139}, 6);
  ExpectNear(Palette(ColorMap::kViridis)[192], {94, 201, 98}, 6);
  EXPECT_EQ(Palette(ColorMap::kViridis)[255], (Rgb{253, 231, 37}));
}

TEST(ColorizeDisparity, SpreadsTheRangeOverThePalette) {
  BufferPool pool;
  DisparityMap map = MakeMap(pool, {{0, 16 * 10, 16 * 15, 16 * 20, 16 * 90}});
  const ColorImage grey = ColorizeDisparity(map, ColorMap::kGrey, 10, 20, pool);
  EXPECT_EQ(grey.Row(0)[0], (Rgb{0, 0, 0})) << "invalid";
  EXPECT_EQ(grey.Row(0)[1], (Rgb{0, 0, 0}));
  EXPECT_EQ(grey.Row(0)[2], (Rgb{128, 128, 128}));
  EXPECT_EQ(grey.Row(0)[3], (Rgb{255, 255, 255}));
  EXPECT_EQ(grey.Row(0)[4], (Rgb{255, 255, 255})) << "nearer than the range";
  EXPECT_EQ(ColorizeDisparity(map, ColorMap::kHue, 10, 20, pool).Row(0)[0], (Rgb{255, 0, 0}));
  map.offset_px = -5;
  EXPECT_EQ(ColorizeDisparity(map, ColorMap::kGrey, 10, 20, pool).Row(0)[3], (Rgb{128, 128, 128}));
}

TEST(ColorizeDepth, GivesTheLastColourToTheNearest) {
  BufferPool pool;
  DepthMap map{.depth_m = MakeImage<float>(pool, {{NAN, 0.2F, 1.0F, 1.5F, 2.0F, 9.0F}})};
  const ColorImage grey = ColorizeDepth(map, ColorMap::kGrey, 1, 2, pool);
  EXPECT_EQ(grey.Row(0)[0], (Rgb{0, 0, 0}));
  EXPECT_EQ(grey.Row(0)[1], (Rgb{255, 255, 255}));
  EXPECT_EQ(grey.Row(0)[2], (Rgb{255, 255, 255}));
  EXPECT_EQ(grey.Row(0)[3], (Rgb{128, 128, 128}));
  EXPECT_EQ(grey.Row(0)[4], (Rgb{0, 0, 0}));
  EXPECT_EQ(grey.Row(0)[5], (Rgb{0, 0, 0}));
}

}  // namespace
}  // namespace vs
