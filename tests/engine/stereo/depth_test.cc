#include "engine/stereo/depth.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/engine/stereo/pictures.h"

namespace vs {
namespace {

class Depth : public testing::Test {
 protected:
  DisparityMap Map(std::initializer_list<std::initializer_list<uint16_t>> rows) {
    DisparityMap map = MakeMap(pool_, rows);
    map.geometry.focal_px = 500;
    map.geometry.baseline_m = 0.12;
    return map;
  }
  BufferPool pool_;
};

TEST_F(Depth, IsFocalLengthTimesBaselineOverDisparity) {
  // 500 px * 0.12 m = 60 px m: 60 px -> 1 m, 30.5 px -> 1.967 m.
  const auto depth = DepthFromDisparity(Map({{960, 488, 0}}), pool_);
  ASSERT_TRUE(depth.has_value());
  EXPECT_FLOAT_EQ(depth->depth_m.Row(0)[0], 1.0F);
  EXPECT_FLOAT_EQ(depth->depth_m.Row(0)[1], 60.0F / 30.5F);
  EXPECT_TRUE(std::isnan(depth->depth_m.Row(0)[2]));
  EXPECT_EQ(depth->geometry.focal_px, 500);
}

TEST_F(Depth, CountsTheOffsetsOfRangeAndPrincipalPoints) {
  DisparityMap map = Map({{960, 320, 16}});
  map.offset_px = -21;
  map.geometry.principal_offset_px = 1;
  // 60 - 21 + 1 = 40 px -> 1.5 m; 20 - 21 + 1 = 0 and 1 - 20 < 0 are at or beyond infinity.
  const auto depth = DepthFromDisparity(map, pool_);
  ASSERT_TRUE(depth.has_value());
  EXPECT_FLOAT_EQ(depth->depth_m.Row(0)[0], 1.5F);
  EXPECT_TRUE(std::isnan(depth->depth_m.Row(0)[1]));
  EXPECT_TRUE(std::isnan(depth->depth_m.Row(0)[2]));
}

TEST_F(Depth, NeedsTheGeometry) {
  DisparityMap map = Map({{960}});
  map.geometry.focal_px = 0;
  const auto depth = DepthFromDisparity(map, pool_);
  ASSERT_FALSE(depth.has_value());
  EXPECT_EQ(depth.error().code(), StatusCode::kFailedPrecondition);
}

TEST_F(Depth, PointsLieWhereThePixelsLook) {
  DisparityMap map = Map({{960, 0, 480}, {0, 480, 960}});
  map.geometry.cx_px = 1;
  map.geometry.cy_px = 0.5;
  const auto depth = DepthFromDisparity(map, pool_);
  ASSERT_TRUE(depth.has_value());
  const auto cloud = PointsFromDepth(*depth, pool_);
  ASSERT_TRUE(cloud.has_value());
  // 1 m away, one pixel of 500 to the left and half a one up.
  EXPECT_FLOAT_EQ(cloud->x_m.Row(0)[0], -0.002F);
  EXPECT_FLOAT_EQ(cloud->y_m.Row(0)[0], -0.001F);
  EXPECT_FLOAT_EQ(cloud->z_m.Row(0)[0], 1.0F);
  // 2 m away, on the axis but for half a pixel down.
  EXPECT_FLOAT_EQ(cloud->x_m.Row(1)[1], 0.0F);
  EXPECT_FLOAT_EQ(cloud->y_m.Row(1)[1], 0.002F);
  for (const auto* image : {&cloud->x_m, &cloud->y_m, &cloud->z_m}) {
    EXPECT_TRUE(std::isnan(image->Row(0)[1]));
  }
  EXPECT_EQ(cloud->geometry, map.geometry);
}

TEST_F(Depth, PointsNeedTheGeometry) {
  const DepthMap depth{Image<float>(pool_, 2, 2), {}};
  EXPECT_EQ(PointsFromDepth(depth, pool_).error().code(), StatusCode::kFailedPrecondition);
}

}  // namespace
}  // namespace vs
