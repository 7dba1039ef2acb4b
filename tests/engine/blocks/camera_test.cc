#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/camera/camera_hub.h"
#include "tests/engine/camera/picture_files.h"
#include "tests/support/block_harness.h"
#include "tests/support/temp_folder.h"
#include "tests/support/wait_until.h"

namespace vs::test {
namespace {

using ::testing::HasSubstr;

class CameraBlock : public testing::Test {
 protected:
  CameraBlock() { block_.environment.cameras = &hub_; }

  CameraHub hub_;
  TempFolder folder_;
  BlockHarness block_{"Camera"};
};

TEST_F(CameraBlock, HandsOnEachRecordedPicture) {
  WriteGrey(folder_ / "1.pgm", 10);
  WriteGrey(folder_ / "2.pgm", 20);
  ASSERT_TRUE(block_.Set("address", "file:" + folder_.path().string()).ok());
  ASSERT_TRUE(block_.Start().ok());
  for (int i = 1; i <= 2; ++i) {
    ASSERT_TRUE(WaitUntil([&] { return block_.block().Ready(); }));
    ASSERT_TRUE(block_.Run().ok());
    const auto* picture = block_.Output<Frame>("picture");
    ASSERT_NE(picture, nullptr);
    EXPECT_EQ(picture->number, static_cast<uint64_t>(i));
    EXPECT_EQ(block_.Output<GreyImage>("image")->Row(0)[0], 10 * i);
    EXPECT_EQ(block_.frame.source_number, static_cast<uint64_t>(i));
    EXPECT_GT(block_.frame.capture_ns, 0);
    EXPECT_GT(block_.frame.arrival_ns, 0);
  }
  EXPECT_EQ(block_.block().Dropped(), 0u);
}

TEST_F(CameraBlock, SetsNothingWhenThereIsNoPictureYet) {
  ASSERT_TRUE(block_.Set("address", std::string("gev-ip:127.9.9.9")).ok());
  ASSERT_TRUE(block_.Start().ok()) << "a camera that is not there yet is waited for";
  EXPECT_FALSE(block_.block().Ready());
  ASSERT_TRUE(block_.Run().ok());
  EXPECT_TRUE(block_.Output("picture").empty());
}

TEST_F(CameraBlock, SaysWhatIsWrongWithItsAddress) {
  EXPECT_THAT(block_.Start().message(), HasSubstr("set address"));
  ASSERT_TRUE(block_.Set("address", std::string("21000001")).ok());
  EXPECT_EQ(block_.Start().code(), StatusCode::kInvalidArgument);
  ASSERT_TRUE(block_.Set("address", std::string("usb:1")).ok());
  EXPECT_EQ(block_.Start().code(), StatusCode::kNotFound);
  ASSERT_TRUE(block_.Set("address", "file:" + folder_.path().string()).ok());
  EXPECT_THAT(block_.Start().message(), HasSubstr("the folder is empty"));
  block_.environment.cameras = nullptr;
  EXPECT_EQ(block_.Start().code(), StatusCode::kFailedPrecondition);
}

TEST_F(CameraBlock, ReadsNoPicturesOutsideTheAllowedFolders) {
  WriteGrey(folder_ / "secret/1.pgm", 10);
  WriteGrey(folder_ / "data/run7/1.pgm", 20);
  CameraHub hub({.data_dir = folder_ / "data", .picture_roots = {}});
  block_.environment.cameras = &hub;
  for (const std::string& outside : {std::string("../secret"), (folder_ / "secret").string()}) {
    ASSERT_TRUE(block_.Set("address", "file:" + outside).ok());
    EXPECT_EQ(block_.Start().code(), StatusCode::kInvalidArgument) << outside;
  }
  ASSERT_TRUE(block_.Set("address", std::string("file:run7")).ok());
  ASSERT_TRUE(block_.Start().ok());
  ASSERT_TRUE(WaitUntil([&] { return block_.block().Ready(); }));
  ASSERT_TRUE(block_.Run().ok());
  EXPECT_EQ(block_.Output<GreyImage>("image")->Row(0)[0], 20);
  block_.block().Stop();
}

TEST_F(CameraBlock, StopEndsAReaderThatWaits) {
  for (int i = 0; i < 20; ++i) WriteGrey(folder_ / (std::to_string(i) + ".pgm"), 1);
  ASSERT_TRUE(block_.Set("address", "file:" + folder_.path().string()).ok());
  ASSERT_TRUE(block_.Start().ok());
  ASSERT_TRUE(WaitUntil([&] { return block_.block().Ready(); }));
  block_.block().Stop();
  ASSERT_TRUE(block_.Start().ok());
  ASSERT_TRUE(WaitUntil([&] { return block_.block().Ready(); }));
  ASSERT_TRUE(block_.Run().ok());
  EXPECT_EQ(block_.Output<Frame>("picture")->number, 1u) << "a new start begins anew";
}

}  // namespace
}  // namespace vs::test
