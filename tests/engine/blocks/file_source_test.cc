#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/engine/camera/picture_files.h"
#include "tests/support/block_harness.h"
#include "tests/support/temp_folder.h"
#include "tests/support/wait_until.h"

namespace vs::test {
namespace {

using ::testing::HasSubstr;

class FileSourceBlock : public testing::Test {
 protected:
  // The next pair; null when the play has ended.
  const StereoFrame* Next() {
    EXPECT_TRUE(WaitUntil([&] { return block_.block().Ready(); }));
    EXPECT_TRUE(block_.Run().ok());
    return block_.Output<StereoFrame>("pair");
  }

  TempFolder folder_;
  BlockHarness block_{"FileSource"};
};

TEST_F(FileSourceBlock, PlaysPairsWithTheirTruth) {
  for (const char* name : {"a", "b"}) {
    WriteGrey(folder_ / (std::string(name) + "_left.png"), 1);
    WriteGrey(folder_ / (std::string(name) + "_right.png"), 2);
    WriteGrey16(folder_ / (std::string(name) + "_disp.png"), 512);
  }
  ASSERT_TRUE(block_.Set("folder", folder_.path().string()).ok());
  ASSERT_TRUE(block_.Start().ok());
  for (uint64_t number = 1; number <= 2; ++number) {
    const StereoFrame* pair = Next();
    ASSERT_NE(pair, nullptr);
    EXPECT_EQ(pair->number, number);
    EXPECT_FALSE(pair->geometry.has_value());
    ASSERT_NE(pair->truth, nullptr);
    EXPECT_EQ(pair->truth->disparity_px.Row(0)[0], 2);
    EXPECT_EQ(block_.frame.source_number, number);
    EXPECT_GT(block_.frame.capture_ns, 0);
  }
}

TEST_F(FileSourceBlock, TellsTheGeometryOfRectifiedPictures) {
  WriteGrey(folder_ / "left.png", 1);
  WriteGrey(folder_ / "right.png", 2);
  block_.environment.folders.data_dir = folder_.path().parent_path();
  ASSERT_TRUE(block_.Set("folder", folder_.path().filename().string()).ok());
  ASSERT_TRUE(block_.Set("rectified", true).ok());
  ASSERT_TRUE(block_.Set("focal_px", 999.421).ok());
  ASSERT_TRUE(block_.Set("baseline_m", 0.193001).ok());
  ASSERT_TRUE(block_.Set("offset_px", 32.778).ok());
  ASSERT_TRUE(block_.Start().ok());
  const StereoFrame* pair = Next();
  ASSERT_NE(pair, nullptr);
  EXPECT_EQ(pair->geometry, (RectifiedGeometry{.width = 8,
                                               .height = 6,
                                               .focal_px = 999.421,
                                               .baseline_m = 0.193001,
                                               .principal_offset_px = 32.778}));
}

TEST_F(FileSourceBlock, ReadsNoPicturesOutsideTheAllowedFolders) {
  WriteGrey(folder_ / "secret/left.png", 1);
  WriteGrey(folder_ / "secret/right.png", 2);
  WriteGrey(folder_ / "data/left.png", 3);
  block_.environment.folders = {.data_dir = folder_ / "data", .picture_roots = {}};
  for (const std::string& outside : {std::string("../secret"), (folder_ / "secret").string()}) {
    ASSERT_TRUE(block_.Set("folder", outside).ok());
    EXPECT_EQ(block_.Start().code(), StatusCode::kInvalidArgument) << outside;
  }
  ASSERT_TRUE(block_.Set("folder", std::string(".")).ok());
  ASSERT_TRUE(block_.Set("left", std::string("left.png")).ok());
  ASSERT_TRUE(block_.Set("right", std::string("../secret/right.png")).ok());
  EXPECT_EQ(block_.Start().code(), StatusCode::kInvalidArgument) << "nor by their names";

  block_.environment.folders.picture_roots = {folder_ / "secret"};
  ASSERT_TRUE(block_.Set("folder", (folder_ / "secret").string()).ok());
  ASSERT_TRUE(block_.Set("right", std::string("right.png")).ok());
  ASSERT_TRUE(block_.Start().ok());
  EXPECT_EQ(Next()->left->image.Row(0)[0], 1);
}

TEST_F(FileSourceBlock, ReportsThePicturesThatItLeftOut) {
  for (const char* name : {"a_left.png", "a_right.png", "b_left.png"}) {
    WriteGrey(folder_ / name, 1);
  }
  WriteText(folder_ / "b_right.png", "no picture");
  ASSERT_TRUE(block_.Set("folder", folder_.path().string()).ok());
  ASSERT_TRUE(block_.Start().ok());
  ASSERT_NE(Next(), nullptr);
  ASSERT_TRUE(WaitUntil([&] { return !block_.block().Report().problem.empty(); }));
  const SourceReport report = block_.block().Report();
  EXPECT_THAT(report.problem, HasSubstr("right camera: "));
  EXPECT_THAT(report.problem, HasSubstr("b_right.png is not a readable picture"));
  EXPECT_THAT(report.readings, testing::Contains(Reading{"right_incomplete", int64_t{1}}));
  EXPECT_THAT(report.readings, testing::Contains(Reading{"pairs", int64_t{1}}));
}

TEST_F(FileSourceBlock, SaysWhatIsWrongWithTheFolder) {
  EXPECT_THAT(block_.Start().message(), HasSubstr("set folder"));
  ASSERT_TRUE(block_.Set("folder", folder_.path().string() + "/nowhere").ok());
  EXPECT_EQ(block_.Start().code(), StatusCode::kNotFound);
  ASSERT_TRUE(block_.Set("folder", folder_.path().string()).ok());
  EXPECT_THAT(block_.Start().message(), HasSubstr("the folder is empty"));
  WriteText(folder_ / "left.png", "no picture");
  WriteText(folder_ / "right.png", "no picture");
  EXPECT_THAT(block_.Start().message(), HasSubstr("is not a readable picture"));
}

}  // namespace
}  // namespace vs::test
