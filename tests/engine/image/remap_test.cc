#include "engine/image/remap.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "engine/image/buffer.h"
#include "engine/image/opencv_view.h"

namespace vs {
namespace {

using testing::ElementsAre;

std::vector<int> RemapRow(BufferPool& pool, const std::vector<uint8_t>& in_row,
                          const std::vector<RemapTable::Source>& sources,
                          Interpolation interpolation) {
  GreyImage in(pool, static_cast<int>(in_row.size()), 4);
  for (int y = 0; y < 4; ++y) std::copy(in_row.begin(), in_row.end(), in.Row(y));
  const RemapTable table{
      .width = static_cast<int>(sources.size()), .height = 1, .sources = sources};
  GreyImage out(pool, table.width, 1);
  Remap(in, table, interpolation, &out);
  return {out.Row(0), out.Row(0) + out.width()};
}

TEST(Remap, InterpolatesBetweenPixels) {
  BufferPool pool;
  const std::vector<uint8_t> row = {0, 100, 200, 100, 0};
  const std::vector<RemapTable::Source> sources = {{1, 1, 0, 0}, {1, 1, 8, 0}, {1, 1, 16, 16}};
  EXPECT_THAT(RemapRow(pool, row, sources, Interpolation::kNearest), ElementsAre(100, 100, 200));
  EXPECT_THAT(RemapRow(pool, row, sources, Interpolation::kLinear), ElementsAre(100, 125, 150));
  // Keys' weights with a = -0.75: a quarter on -0.105, 0.879, 0.262, -0.035 (136.7), half-way
  // -3/32, 19/32, 19/32, -3/32 (168.75).
  EXPECT_THAT(RemapRow(pool, row, sources, Interpolation::kCubic), ElementsAre(100, 137, 169));
}

TEST(Remap, TakesWhatLiesOutsideForBlack) {
  BufferPool pool;
  const std::vector<RemapTable::Source> sources = {
      {-1, 1, 16, 0}, {2, 1, 16, 0}, {0, 3, 0, 16}, {-9, 1, 0, 0}, {32767, -32768, 31, 31}};
  EXPECT_THAT(RemapRow(pool, {200, 200, 200}, sources, Interpolation::kLinear),
              ElementsAre(100, 100, 100, 0, 0));
}

TEST(Remap, AgreesWithOpenCvToOneGreyLevel) {
  BufferPool pool;
  std::mt19937 random(3);
  GreyImage in(pool, 61, 47);
  for (int y = 0; y < 47; ++y) {
    for (int x = 0; x < 61; ++x) in.Row(y)[x] = static_cast<uint8_t>(random());
  }
  RemapTable table{.width = 50, .height = 40};
  cv::Mat pixels(40, 50, CV_16SC2);
  cv::Mat parts(40, 50, CV_16U);
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 50; ++x) {
      const RemapTable::Source source{
          static_cast<int16_t>(random() % 70 - 4), static_cast<int16_t>(random() % 56 - 4),
          static_cast<uint8_t>(random() % 32), static_cast<uint8_t>(random() % 32)};
      table.sources.push_back(source);
      pixels.at<cv::Vec2s>(y, x) = {source.x, source.y};
      parts.at<uint16_t>(y, x) = static_cast<uint16_t>(source.y_part * 32 + source.x_part);
    }
  }
  for (const auto& [ours, theirs] : {std::pair{Interpolation::kLinear, cv::INTER_LINEAR},
                                     std::pair{Interpolation::kCubic, cv::INTER_CUBIC}}) {
    GreyImage out(pool, 50, 40);
    Remap(in, table, ours, &out);
    cv::Mat expected;
    cv::remap(CvView(in), expected, pixels, parts, theirs, cv::BORDER_CONSTANT, cv::Scalar(0));
    EXPECT_LE(cv::norm(CvView(out), expected, cv::NORM_INF), 1);
  }
}

// On a slope of 8 grey levels for each pixel.
TEST(Remap, PositionsAreExactWhereSourcesAreRounded) {
  BufferPool pool;
  GreyImage slope(pool, 30, 4);
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 30; ++x) slope.Row(y)[x] = static_cast<uint8_t>(8 * x);
  }
  RemapTable table{.width = 200, .height = 1};
  for (int k = 0; k < 200; ++k)
    table.positions.push_back({2 + 0.125F * static_cast<float>(k), 1.3F});
  for (const Interpolation interpolation : {Interpolation::kLinear, Interpolation::kCubic}) {
    GreyImage out(pool, 200, 1);
    Remap(slope, table, interpolation, &out);
    for (int k = 0; k < 200; ++k) ASSERT_EQ(out.Row(0)[k], 16 + k) << k;
  }
  GreyImage out(pool, 200, 1);
  Remap(slope, table, Interpolation::kNearest, &out);
  EXPECT_EQ(out.Row(0)[3], 16);
  EXPECT_EQ(out.Row(0)[4], 24);
}

TEST(Remap, PositionsMayBeAnything) {
  BufferPool pool;
  GreyImage in(pool, 20, 20);
  in.Fill(200);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  const RemapTable table{
      .width = 6,
      .height = 1,
      .positions = {{-0.5F, 3}, {19.5F, 3}, {nan, 3}, {3, -infinity}, {1e30F, 1e30F}, {-1, 3}}};
  GreyImage out(pool, 6, 1);
  Remap(in, table, Interpolation::kLinear, &out);
  EXPECT_THAT(std::vector<int>(out.Row(0), out.Row(0) + 6), ElementsAre(100, 100, 0, 0, 0, 0));
  for (const Interpolation interpolation : {Interpolation::kNearest, Interpolation::kCubic}) {
    Remap(in, table, interpolation, &out);
    EXPECT_EQ(out.Row(0)[2] + out.Row(0)[3] + out.Row(0)[4], 0);
  }
}

// Both kinds of table, linearly: pieces that lie inside are mixed side by side, others one by one.
TEST(Remap, GivesAPixelTheSameValueWhereverItsNeighboursLie) {
  BufferPool pool;
  std::mt19937 random(5);
  GreyImage in(pool, 90, 70);
  for (int y = 0; y < 70; ++y) {
    for (int x = 0; x < 90; ++x) in.Row(y)[x] = static_cast<uint8_t>(random());
  }
  RemapTable fixed{.width = 130, .height = 2};
  RemapTable exact{.width = 130, .height = 2};
  for (int k = 0; k < 130; ++k) {
    const RemapTable::Source source{
        static_cast<int16_t>(random() % 88), static_cast<int16_t>(random() % 68),
        static_cast<uint8_t>(random() % 32), static_cast<uint8_t>(random() % 32)};
    fixed.sources.push_back(source);
    const auto part = [&random] { return static_cast<float>(random() % 1000) / 1000; };
    exact.positions.push_back({source.x + part(), source.y + part()});
  }
  for (int k = 0; k < 130; ++k) {  // the second row: every third one lies outside
    fixed.sources.push_back(k % 3 == 0 ? RemapTable::Source{-20, 5, 0, 0} : fixed.sources[k]);
    exact.positions.push_back(k % 3 == 0 ? RemapTable::Position{-20, 5} : exact.positions[k]);
  }
  for (const RemapTable* table : {&fixed, &exact}) {
    GreyImage out(pool, 130, 2);
    Remap(in, *table, Interpolation::kLinear, &out);
    for (int k = 0; k < 130; ++k) {
      ASSERT_EQ(out.Row(1)[k], k % 3 == 0 ? 0 : out.Row(0)[k]) << k;
    }
  }
}

}  // namespace
}  // namespace vs
