#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <opencv2/imgcodecs.hpp>

#include "tests/support/block_harness.h"
#include "tests/support/temp_folder.h"

namespace vs {
namespace {

using test::BlockHarness;

class StoppedClock final : public Clock {
 public:
  int64_t MonotonicNs() const override { return 1; }
  int64_t UtcNs() const override { return 1'790'000'000'012'345'678; }
};

class SaveImages : public ::testing::Test {
 protected:
  SaveImages() {
    block_.environment.folders.data_dir = root_.path();
    block_.environment.clock = &clock_;
    EXPECT_TRUE(block_.Set("min_free_mb", int64_t{0}).ok());
  }
  std::vector<std::string> Files() const {
    std::vector<std::string> names;
    for (const auto& file : std::filesystem::recursive_directory_iterator(root_.path())) {
      if (file.is_regular_file()) names.push_back(file.path().lexically_relative(root_.path()));
    }
    std::sort(names.begin(), names.end());
    return names;
  }
  cv::Mat Load(const std::string& file) const {
    return cv::imread((root_ / file).string(), cv::IMREAD_UNCHANGED);
  }

  test::TempFolder root_;
  StoppedClock clock_;
  BufferPool pool_;
  BlockHarness block_{"SaveImages"};
};

std::shared_ptr<const Frame> FrameOf(BufferPool& pool, uint8_t grey) {
  Frame frame;
  frame.image = GreyImage(pool, 5, 3);
  frame.image.Fill(grey);
  frame.image.Row(2)[4] = 99;
  return std::make_shared<const Frame>(frame);
}

TEST_F(SaveImages, WritesBothPicturesOfAPair) {
  StereoFrame pair;
  pair.left = FrameOf(pool_, 10);
  pair.right = FrameOf(pool_, 20);
  block_.Input("picture", std::make_shared<const StereoFrame>(pair));
  ASSERT_TRUE(block_.Start().ok());
  ASSERT_TRUE(block_.Run().ok());
  // 1790000000 s = 2026-09-21 14:13:20 UTC.
  EXPECT_EQ(Files(),
            (std::vector<std::string>{"images/20260921T141320.012345Z_00000001_left.png",
                                      "images/20260921T141320.012345Z_00000001_right.png"}));
  EXPECT_EQ(*block_.Output<std::string>("path"), Files()[0]);
  EXPECT_EQ(*block_.Output<int64_t>("saved"), 2);
  const cv::Mat right = Load(Files()[1]);
  ASSERT_EQ(right.type(), CV_8UC1);
  ASSERT_EQ(right.size(), cv::Size(5, 3));
  EXPECT_EQ(right.at<uint8_t>(0, 0), 20);
  EXPECT_EQ(right.at<uint8_t>(2, 4), 99);
}

TEST_F(SaveImages, WritesDisparityIn256thsOfAPixel) {
  DisparityMap map{Image<uint16_t>(pool_, 3, 1), GreyImage(pool_, 3, 1), GreyImage(pool_, 3, 1)};
  map.offset_px = 2;
  map.disparity.Row(0)[0] = 5 * 16 + 4;
  map.disparity.Row(0)[1] = kInvalidDisparity;
  map.disparity.Row(0)[2] = 256 * 16;
  block_.Input("picture", std::make_shared<const DisparityMap>(map));
  ASSERT_TRUE(block_.Start().ok());
  ASSERT_TRUE(block_.Run().ok());
  const cv::Mat saved = Load(Files()[0]);
  ASSERT_EQ(saved.type(), CV_16UC1);
  EXPECT_EQ(saved.at<uint16_t>(0, 0), 7.25 * 256);
  EXPECT_EQ(saved.at<uint16_t>(0, 1), 0);
  EXPECT_EQ(saved.at<uint16_t>(0, 2), 65535) << "the largest that fits";

  map.offset_px = -1;
  block_.Input("picture", std::make_shared<const DisparityMap>(map));
  EXPECT_EQ(block_.Run().code(), StatusCode::kInvalidArgument);
}

TEST_F(SaveImages, WritesDepthInMillimetresAndColourAsItIs) {
  DepthMap map{Image<float>(pool_, 3, 1), {}};
  map.depth_m.Row(0)[0] = 1.2345F;
  map.depth_m.Row(0)[1] = std::nanf("");
  map.depth_m.Row(0)[2] = 100.0F;
  block_.Input("picture", std::make_shared<const DepthMap>(map));
  ASSERT_TRUE(block_.Start().ok());
  ASSERT_TRUE(block_.Run().ok());
  const cv::Mat depth = Load(Files()[0]);
  EXPECT_EQ(depth.at<uint16_t>(0, 0), 1235);
  EXPECT_EQ(depth.at<uint16_t>(0, 1), 0);
  EXPECT_EQ(depth.at<uint16_t>(0, 2), 65535);

  ColorImage picture(pool_, 2, 1);
  picture.Fill({200, 100, 50});
  block_.Input("picture", std::make_shared<const ColorImage>(picture));
  ASSERT_TRUE(block_.Run().ok());
  EXPECT_EQ(Load(*block_.Output<std::string>("path")).at<cv::Vec3b>(0, 0), cv::Vec3b(50, 100, 200));
}

TEST_F(SaveImages, WritesPointsAsPly) {
  PointCloud cloud{
      Image<float>(pool_, 1, 1), Image<float>(pool_, 1, 1), Image<float>(pool_, 1, 1), {}};
  cloud.x_m.Fill(1);
  cloud.y_m.Fill(2);
  cloud.z_m.Fill(3);
  block_.Input("picture", std::make_shared<const PointCloud>(cloud));
  ASSERT_TRUE(block_.Start().ok());
  ASSERT_TRUE(block_.Run().ok());
  const std::string path = *block_.Output<std::string>("path");
  EXPECT_TRUE(path.ends_with("_points.ply")) << path;
  EXPECT_EQ(Files().size(), 1u);
}

TEST_F(SaveImages, ChoosesFramesByItsPolicy) {
  block_.Input("picture", FrameOf(pool_, 1));
  block_.Input("pass", true);
  ASSERT_TRUE(block_.Set("policy", std::string("every_nth")).ok());
  ASSERT_TRUE(block_.Set("every_nth", int64_t{3}).ok());
  ASSERT_TRUE(block_.Start().ok());
  std::string saved;
  for (int i = 0; i < 7; ++i) {
    ASSERT_TRUE(block_.Run().ok());
    saved += block_.Output("path").empty() ? '.' : 'X';
  }
  EXPECT_EQ(saved, "X..X..X");

  ASSERT_TRUE(block_.Set("policy", std::string("fail")).ok());
  ASSERT_TRUE(block_.Run().ok());
  EXPECT_TRUE(block_.Output("path").empty());
  block_.Input("pass", false);
  ASSERT_TRUE(block_.Run().ok());
  EXPECT_FALSE(block_.Output("path").empty());
  block_.Input("pass", Value());
  ASSERT_TRUE(block_.Run().ok());
  EXPECT_FALSE(block_.Output("path").empty()) << "a part of which nothing is known";
}

TEST_F(SaveImages, SaysThatItIsFull) {
  block_.Input("picture", FrameOf(pool_, 1));
  ASSERT_TRUE(block_.Set("max_files", int64_t{1}).ok());
  ASSERT_TRUE(block_.Start().ok());
  ASSERT_TRUE(block_.Run().ok());
  EXPECT_EQ(block_.Run().code(), StatusCode::kResourceExhausted);
  ASSERT_TRUE(block_.Set("when_full", std::string("delete_oldest")).ok());
  ASSERT_TRUE(block_.Run().ok());
  EXPECT_EQ(Files(),
            (std::vector<std::string>{"images/20260921T141320.012345Z_00000003_picture.png"}));
}

TEST_F(SaveImages, StaysInsideTheDataFolder) {
  block_.Input("picture", FrameOf(pool_, 1));
  for (const char* bad : {"", "/etc", "..", "a/../..", ".hidden", "a//../b", "a b", "~root"}) {
    EXPECT_EQ(block_.Set("folder", std::string(bad)).code(), StatusCode::kInvalidArgument) << bad;
  }
  ASSERT_TRUE(block_.Set("folder", std::string("line_1/camera-2/v1.0")).ok());
  EXPECT_TRUE(block_.Start().ok());
  block_.environment.folders.data_dir.clear();
  EXPECT_EQ(block_.Start().code(), StatusCode::kFailedPrecondition);
}

TEST_F(SaveImages, NeedsAPictureAndForThePolicyFailAVerdict) {
  block_.Input("picture", 1.5);
  EXPECT_EQ(block_.Start().code(), StatusCode::kInvalidArgument);
  block_.Input("picture", FrameOf(pool_, 1));
  ASSERT_TRUE(block_.Set("policy", std::string("fail")).ok());
  EXPECT_EQ(block_.block().CheckParams().code(), StatusCode::kInvalidArgument);
  block_.Input("pass", true);
  EXPECT_TRUE(block_.block().CheckParams().ok());
}

}  // namespace
}  // namespace vs
