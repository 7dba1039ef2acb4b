#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "engine/base/clock.h"
#include "engine/base/mailbox.h"
#include "engine/camera/camera_source.h"
#include "tests/engine/camera/picture_files.h"
#include "tests/support/temp_folder.h"
#include "tests/support/wait_until.h"

namespace vs::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::unique_ptr<CameraSource> Open(const std::string& uri) {
  auto camera = CameraDrivers::Get().Make(CameraUri::Parse(uri).value());
  EXPECT_TRUE(camera.has_value()) << camera.error().ToString();
  return std::move(*camera);
}

// Plays a recording to its end.
std::vector<FramePtr> PlayAll(CameraSource& camera) {
  Mailbox<FramePtr> box(Mailbox<FramePtr>::Policy::kEvery);
  const Status status = camera.Start([&box](FramePtr frame) { box.Put(std::move(frame)); });
  EXPECT_TRUE(status.ok()) << status.ToString();
  std::vector<FramePtr> frames;
  while (camera.Stats().state == CameraState::kStreaming || box.Available()) {
    if (auto frame = box.TryTake()) {
      frames.push_back(std::move(*frame));
    } else {
      std::this_thread::yield();
    }
  }
  camera.Stop();
  return frames;
}

std::vector<int> GreyValues(const std::vector<FramePtr>& frames) {
  std::vector<int> values;
  values.reserve(frames.size());
  for (const FramePtr& frame : frames) values.push_back(frame->image.Row(0)[0]);
  return values;
}

TEST(FileCamera, PlaysAFolderOnceInCountingOrder) {
  TempFolder folder;
  WriteGrey(folder / "img10.pgm", 30);
  WriteGrey(folder / "img2.pgm", 20);
  WriteGrey(folder / "img1.pgm", 10);
  const auto camera = Open("file:" + folder.path().string());
  EXPECT_TRUE(camera->Recorded());
  const auto frames = PlayAll(*camera);
  EXPECT_THAT(GreyValues(frames), ElementsAre(10, 20, 30));
  EXPECT_EQ(frames[2]->number, 3u);
  EXPECT_EQ(frames[2]->image.width(), 8);
  EXPECT_EQ(frames[2]->image.height(), 6);
  EXPECT_EQ(camera->Stats().frames, 3u);
  EXPECT_EQ(camera->Stats().state, CameraState::kIdle);
}

TEST(FileCamera, TakesOnlyWhatMatchesThePattern) {
  TempFolder folder;
  WriteGrey(folder / "a_left.pgm", 1);
  WriteGrey(folder / "a_right.pgm", 2);
  WriteGrey(folder / "b_left.pgm", 3);
  const auto camera = Open("file:" + folder.path().string() + "?pattern=*_left.pgm");
  EXPECT_THAT(GreyValues(PlayAll(*camera)), ElementsAre(1, 3));
}

TEST(FileCamera, IsNoFasterThanTheGivenRate) {
  TempFolder folder;
  for (const char* name : {"1.pgm", "2.pgm", "3.pgm", "4.pgm", "5.pgm"}) {
    WriteGrey(folder / name, 1);
  }
  const auto camera = Open("file:" + folder.path().string() + "?fps=100");
  const int64_t begin_ns = SystemClock().MonotonicNs();
  const auto frames = PlayAll(*camera);
  ASSERT_EQ(frames.size(), 5u);
  for (int i = 0; i < 5; ++i) EXPECT_GE(frames[i]->capture_ns - begin_ns, i * 10'000'000) << i;
}

TEST(FileCamera, LoopsUntilItIsStopped) {
  TempFolder folder;
  WriteGrey(folder / "a.pgm", 1);
  WriteGrey(folder / "b.pgm", 2);
  const auto camera = Open("file:" + folder.path().string() + "?loop=true&fps=500");
  Mailbox<FramePtr> box(Mailbox<FramePtr>::Policy::kEvery);
  ASSERT_TRUE(camera->Start([&box](FramePtr frame) { box.Put(std::move(frame)); }).ok());
  for (uint64_t number = 1; number <= 7;) {
    const auto frame = box.TryTake();
    if (!frame) {
      std::this_thread::yield();
      continue;
    }
    EXPECT_EQ((*frame)->number, number);
    EXPECT_EQ((*frame)->image.Row(5)[7], number % 2 == 1 ? 1 : 2);
    ++number;
  }
  box.Close();
  camera->Stop();
}

TEST(FileCamera, SkipsCountsAndNamesUnreadableFiles) {
  TempFolder folder;
  WriteGrey(folder / "1.png", 10);
  WriteText(folder / "2.png", "this is no picture");
  WriteText(folder / "3.png", "P5\n8 6\n255\n");  // cut off
  WriteGrey(folder / "4.png", 40);
  const auto camera = Open("file:" + folder.path().string());
  const auto frames = PlayAll(*camera);
  EXPECT_THAT(GreyValues(frames), ElementsAre(10, 40));
  EXPECT_EQ(frames[1]->number, 4u) << "a gap tells that pictures are missing";
  EXPECT_EQ(camera->Stats().incomplete, 2u);
  EXPECT_THAT(camera->Stats().last_error, HasSubstr("3.png is not a readable picture"));
}

TEST(FileCamera, StopsLoopingWhenNoPictureIsLeft) {
  TempFolder folder;
  WriteGrey(folder / "a.pgm", 1);
  WriteGrey(folder / "b.pgm", 2);
  const auto camera = Open("file:" + folder.path().string() + "?loop=true");
  ASSERT_TRUE(camera->Start([](const FramePtr&) {}).ok());
  std::filesystem::remove(folder / "a.pgm");
  ASSERT_TRUE(WaitUntil([&] { return camera->Stats().incomplete > 0; }));
  EXPECT_EQ(camera->Stats().state, CameraState::kStreaming) << "one picture is left";
  std::filesystem::remove(folder / "b.pgm");
  ASSERT_TRUE(WaitUntil([&] { return camera->Stats().state == CameraState::kIdle; }));
  EXPECT_THAT(camera->Stats().last_error, HasSubstr("no picture can be read any more"));
}

TEST(FileCamera, SaysWhyItCannotStart) {
  TempFolder folder;
  const auto start = [](const std::string& uri) {
    return Open(uri)->Start([](const FramePtr&) {});
  };
  const std::string path = folder.path().string();
  Status status = start("file:" + path + "/nowhere");
  EXPECT_EQ(status.code(), StatusCode::kNotFound);
  EXPECT_THAT(status.message(), HasSubstr("there is no folder " + path + "/nowhere"));

  status = start("file:" + path);
  EXPECT_EQ(status.code(), StatusCode::kNotFound);
  EXPECT_THAT(status.message(), HasSubstr("the folder is empty"));

  WriteText(folder / "notes.txt", "not a picture");
  status = start("file:" + path + "?pattern=*.png");
  EXPECT_EQ(status.code(), StatusCode::kNotFound);
  EXPECT_THAT(status.message(), HasSubstr("matches \"*.png\"; there is, for example, notes.txt"));

  status = start("file:" + path);
  EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
  EXPECT_THAT(status.message(), HasSubstr("none of the 1 files"));
  EXPECT_THAT(status.message(), HasSubstr("notes.txt is not a readable picture"));
}

TEST(FileCamera, RefusesOptionsThatMakeNoSense) {
  const auto camera = CameraDrivers::Get().Make(CameraUri::Parse("file:/d?fps=-1&rate=3").value());
  ASSERT_FALSE(camera.has_value());
  EXPECT_THAT(camera.error().faults(),
              ElementsAre(Fault{"fps", "\"-1\" is not a number from 0 to 1000"},
                          Fault{"rate", "unknown option of file:; there are pattern, fps, loop"}));
}

TEST(FileCamera, HasNeitherTriggerNorFeatures) {
  const auto camera = Open("file:/d");
  EXPECT_EQ(camera->Trigger().code(), StatusCode::kFailedPrecondition);
  EXPECT_EQ(camera->GetFeature("Width").error().code(), StatusCode::kNotFound);
  EXPECT_TRUE(camera->Features()->empty());
}

}  // namespace
}  // namespace vs::test
