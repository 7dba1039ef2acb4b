#include "engine/camera/file_pair_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <thread>
#include <vector>

#include "engine/base/clock.h"
#include "engine/base/mailbox.h"
#include "tests/engine/camera/picture_files.h"
#include "tests/support/temp_folder.h"
#include "tests/support/wait_until.h"

namespace vs::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Pair;

std::vector<StereoFramePtr> PlayAll(StereoSource& source) {
  Mailbox<StereoFramePtr> box(Mailbox<StereoFramePtr>::Policy::kEvery);
  const Status status = source.Start([&box](StereoFramePtr pair) { box.Put(std::move(pair)); });
  EXPECT_TRUE(status.ok()) << status.ToString();
  std::vector<StereoFramePtr> pairs;
  while (source.Stats().left.state == CameraState::kStreaming || box.Available()) {
    if (auto pair = box.TryTake()) {
      pairs.push_back(std::move(*pair));
    } else {
      std::this_thread::yield();
    }
  }
  source.Stop();
  return pairs;
}

std::vector<std::pair<int, int>> GreyValues(const std::vector<StereoFramePtr>& pairs) {
  std::vector<std::pair<int, int>> values;
  values.reserve(pairs.size());
  for (const auto& pair : pairs) {
    values.emplace_back(pair->left->image.Row(0)[0], pair->right->image.Row(0)[0]);
  }
  return values;
}

Status StartError(const FilePairOptions& options) {
  return MakeFilePairSource(options)->Start([](const StereoFramePtr&) {});
}

TEST(FilePairSource, FindsPairsByTheWordsLeftAndRight) {
  TempFolder folder;
  for (const int i : {1, 2, 10}) {
    WriteGrey(folder / ("left" + std::to_string(i) + ".png"), static_cast<uint8_t>(i));
    WriteGrey(folder / ("right" + std::to_string(i) + ".png"), static_cast<uint8_t>(100 + i));
  }
  WriteGrey(folder / "left3.png", 3);  // without a partner
  const auto source = MakeFilePairSource({.folder = folder.path()});
  EXPECT_TRUE(source->Recorded());
  const auto pairs = PlayAll(*source);
  EXPECT_THAT(GreyValues(pairs), ElementsAre(Pair(1, 101), Pair(2, 102), Pair(10, 110)));
  EXPECT_EQ(pairs[2]->number, 3u);
  EXPECT_EQ(pairs[2]->skew_ns, 0);
  EXPECT_FALSE(pairs[0]->geometry.has_value());
  EXPECT_EQ(pairs[0]->truth, nullptr);
  EXPECT_EQ(source->Stats().pairing.pairs, 3u);
}

TEST(FilePairSource, IsNoFasterThanTheGivenRate) {
  TempFolder folder;
  for (const int i : {0, 1, 2, 3, 4}) {
    WriteGrey(folder / ("left" + std::to_string(i) + ".png"), 1);
    WriteGrey(folder / ("right" + std::to_string(i) + ".png"), 1);
  }
  const auto source = MakeFilePairSource({.folder = folder.path(), .play = {.fps = 100}});
  const int64_t begin_ns = SystemClock().MonotonicNs();
  const auto pairs = PlayAll(*source);
  ASSERT_EQ(pairs.size(), 5u);
  for (int i = 0; i < 5; ++i) EXPECT_GE(pairs[i]->left->capture_ns - begin_ns, i * 10'000'000) << i;
}

TEST(FilePairSource, FindsPairsByPatternsAlsoInSubfolders) {
  TempFolder folder;
  WriteGrey(folder / "L/007.pgm", 7);
  WriteGrey(folder / "R/007.pgm", 8);
  WriteGrey(folder / "L/009.pgm", 9);
  WriteGrey(folder / "R/008.pgm", 10);
  const auto source = MakeFilePairSource(
      {.folder = folder.path(), .left_pattern = "L/*.pgm", .right_pattern = "R/*.pgm"});
  EXPECT_THAT(GreyValues(PlayAll(*source)), ElementsAre(Pair(7, 8)));
}

TEST(FilePairSource, FindsOnePairByPlainNames) {
  TempFolder folder;
  WriteGrey(folder / "aloeL.jpg", 1);
  WriteGrey(folder / "aloeR.jpg", 2);
  const auto source = MakeFilePairSource(
      {.folder = folder.path(), .left_pattern = "aloeL.jpg", .right_pattern = "aloeR.jpg"});
  EXPECT_THAT(GreyValues(PlayAll(*source)), ElementsAre(Pair(1, 2)));
}

TEST(FilePairSource, BringsTheTruthAlong) {
  TempFolder folder;
  WriteGrey(folder / "left.png", 1);
  WriteGrey(folder / "right.png", 2);
  WriteGrey16(folder / "disp.png", 10 * 256 + 64);
  WriteGrey(folder / "nonocc.png", 255);
  const auto pairs = PlayAll(*MakeFilePairSource({.folder = folder.path()}));
  ASSERT_EQ(pairs.size(), 1u);
  ASSERT_NE(pairs[0]->truth, nullptr);
  EXPECT_EQ(pairs[0]->truth->disparity_px.Row(5)[7], 10.25F);
  EXPECT_EQ(pairs[0]->truth->visible.Row(0)[0], 255);
}

TEST(FilePairSource, ReadsZeroAsUnknownDisparity) {
  TempFolder folder;
  WriteGrey(folder / "a_l.png", 1);
  WriteGrey(folder / "a_r.png", 2);
  WriteGrey16(folder / "a_d.png", 0);
  const auto pairs = PlayAll(*MakeFilePairSource({.folder = folder.path(),
                                                  .left_pattern = "*_l.png",
                                                  .right_pattern = "*_r.png",
                                                  .truth_pattern = "*_d.png"}));
  ASSERT_EQ(pairs.size(), 1u);
  ASSERT_NE(pairs[0]->truth, nullptr);
  EXPECT_TRUE(std::isnan(pairs[0]->truth->disparity_px.Row(0)[0]));
  EXPECT_EQ(pairs[0]->truth->visible.Row(0)[0], 255) << "without a mask all counts as visible";
}

TEST(FilePairSource, ScalesTheGeometryToThePictures) {
  TempFolder folder;
  WriteGrey(folder / "left.png", 1, 8, 6);
  WriteGrey(folder / "right.png", 2, 8, 6);
  const RectifiedGeometry full{.width = 16, .height = 12, .focal_px = 20, .baseline_m = 0.1};
  const auto pairs = PlayAll(*MakeFilePairSource({.folder = folder.path(), .geometry = full}));
  ASSERT_EQ(pairs.size(), 1u);
  ASSERT_TRUE(pairs[0]->geometry.has_value());
  EXPECT_EQ(pairs[0]->geometry->focal_px, 10);
  EXPECT_EQ(pairs[0]->geometry->width, 8);
  EXPECT_EQ(pairs[0]->geometry->baseline_m, 0.1);
}

TEST(FilePairSource, LeavesBadPairsOutAndNamesThem) {
  TempFolder folder;
  WriteGrey(folder / "left1.png", 1);
  WriteGrey(folder / "right1.png", 2);
  WriteGrey(folder / "left2.png", 3);
  WriteText(folder / "right2.png", "no picture");
  WriteGrey(folder / "left3.png", 5, 8, 6);
  WriteGrey(folder / "right3.png", 6, 9, 6);
  WriteGrey(folder / "left4.png", 7);
  WriteGrey(folder / "right4.png", 8);
  const auto source = MakeFilePairSource({.folder = folder.path()});
  const auto pairs = PlayAll(*source);
  EXPECT_THAT(GreyValues(pairs), ElementsAre(Pair(1, 2), Pair(7, 8)));
  EXPECT_EQ(pairs[1]->number, 4u);
  EXPECT_EQ(source->Stats().right.incomplete, 2u);
  EXPECT_THAT(source->Stats().right.last_error, HasSubstr("9 x 6 pixels but its partner 8 x 6"));
}

TEST(FilePairSource, PatternsDoNotLeadOutOfTheFolder) {
  TempFolder folder;
  for (const char* name : {"in/1_left.png", "in/1_right.png", "out/1_right.png"}) {
    WriteGrey(folder / name, 1);
  }
  FilePairOptions options{.folder = folder / "in", .left_pattern = "*_left.png"};
  for (const std::string& outside :
       {std::string("../out/*_right.png"), (folder / "out/*_right.png").string()}) {
    options.right_pattern = outside;
    options.truth_pattern.clear();
    options.visible_pattern.clear();
    EXPECT_EQ(StartError(options).code(), StatusCode::kInvalidArgument) << outside;
    options.right_pattern = "*_right.png";
    options.truth_pattern = outside;
    EXPECT_EQ(StartError(options).code(), StatusCode::kInvalidArgument) << outside;
    options.truth_pattern.clear();
    options.visible_pattern = outside;
    EXPECT_EQ(StartError(options).code(), StatusCode::kInvalidArgument) << outside;
  }
}

TEST(FilePairSource, StopsLoopingWhenNoPairIsLeft) {
  TempFolder folder;
  for (const char* name : {"left1.png", "right1.png", "left2.png", "right2.png"}) {
    WriteGrey(folder / name, 1);
  }
  const auto source = MakeFilePairSource({.folder = folder.path(), .play = {.loop = true}});
  ASSERT_TRUE(source->Start([](const StereoFramePtr&) {}).ok());
  std::filesystem::remove(folder / "left1.png");
  ASSERT_TRUE(WaitUntil([&] { return source->Stats().left.incomplete > 0; }));
  EXPECT_EQ(source->Stats().left.state, CameraState::kStreaming) << "one pair is left";
  std::filesystem::remove(folder / "right2.png");
  ASSERT_TRUE(WaitUntil([&] { return source->Stats().right.state == CameraState::kIdle; }));
  const StereoStats stats = source->Stats();
  EXPECT_THAT(stats.left.last_error + stats.right.last_error,
              HasSubstr("no pair can be used any more"));
}

TEST(FilePairSource, SaysWhyItCannotStart) {
  TempFolder folder;
  EXPECT_THAT(StartError({.folder = folder / "nowhere"}).message(),
              HasSubstr("there is no folder"));
  EXPECT_THAT(StartError({.folder = folder.path(), .left_pattern = "*.png"}).message(),
              HasSubstr("a pattern for the left and for the right pictures"));
  EXPECT_THAT(
      StartError({.folder = folder.path(), .left_pattern = "*_*", .right_pattern = "*"}).message(),
      HasSubstr("at most one '*'"));
  WriteGrey(folder / "x_left.png", 1);
  EXPECT_THAT(StartError({.folder = folder.path()}).message(),
              HasSubstr("x_left.png needs a file with \"right\""));
  EXPECT_THAT(
      StartError(
          {.folder = folder.path(), .left_pattern = "*_left.png", .right_pattern = "r_*.png"})
          .message(),
      HasSubstr("x_left.png needs r_x.png"));
  WriteText(folder / "x_right.png", "no picture");
  const Status status = StartError({.folder = folder.path()});
  EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
  EXPECT_THAT(status.message(), HasSubstr("none of the 1 pairs"));
  EXPECT_THAT(status.message(), HasSubstr("x_right.png is not a readable picture"));
}

TEST(FilePairSource, PlaysTheRealScenes) {
  const char* data = std::getenv("VS_TEST_DATA");
  if (data == nullptr) GTEST_SKIP() << "set VS_TEST_DATA to the folder with the test data";
  const auto source = MakeFilePairSource({.folder = std::filesystem::path(data) / "stereo",
                                          .left_pattern = "*/left.png",
                                          .right_pattern = "*/right.png",
                                          .truth_pattern = "*/disp.png",
                                          .visible_pattern = "*/nonocc.png"});
  const auto pairs = PlayAll(*source);
  EXPECT_GE(pairs.size(), 8u);
  for (const auto& pair : pairs) EXPECT_NE(pair->truth, nullptr);
}

}  // namespace
}  // namespace vs::test
