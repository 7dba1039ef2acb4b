#include "engine/camera/stereo_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "tests/engine/camera/scripted_camera.h"

namespace vs::test {
namespace {

constexpr int64_t kPeriodNs = 33'333'333;

std::shared_ptr<ScriptedCamera> Camera(const char* uri) {
  return std::make_shared<ScriptedCamera>(CameraUri::Parse(uri).value());
}

struct Collected {
  StereoSink Sink() {
    return [this](StereoFramePtr pair) {
      MutexLock lock(mutex);
      pairs.push_back(std::move(pair));
    };
  }
  size_t Count() {
    MutexLock lock(mutex);
    return pairs.size();
  }

  Mutex mutex;
  std::vector<StereoFramePtr> pairs VS_GUARDED_BY(mutex);
};

TEST(CameraPair, JoinsTheTwoCameras) {
  const auto left = Camera("script:left");
  const auto right = Camera("script:right");
  const auto stereo = MakeCameraPair(left, right);
  Collected collected;
  ASSERT_TRUE(stereo->Start(collected.Sink()).ok());
  EXPECT_FALSE(stereo->Recorded());
  left->Deliver(1, 0);
  right->Deliver(1, 1000);
  left->Deliver(2, kPeriodNs);  // its partner is lost
  right->Deliver(3, 2 * kPeriodNs);
  left->Deliver(3, 2 * kPeriodNs);
  stereo->Stop();
  left->Deliver(4, 3 * kPeriodNs);
  right->Deliver(4, 3 * kPeriodNs);
  ASSERT_EQ(collected.Count(), 2u);
  const StereoStats stats = stereo->Stats();
  EXPECT_EQ(stats.pairing.pairs, 2u);
  EXPECT_EQ(stats.pairing.left, (Unpaired{.no_counterpart = 1}));
  EXPECT_EQ(stats.left.frames, 3u);
  EXPECT_EQ(stats.right.frames, 2u);
}

TEST(CameraPair, SaysWhichCameraDidNotStart) {
  const auto left = Camera("script:left");
  const auto stereo = MakeCameraPair(left, Camera("script:broken"));
  Collected collected;
  const Status status = stereo->Start(collected.Sink());
  EXPECT_EQ(status.code(), StatusCode::kUnavailable);
  EXPECT_THAT(status.message(), testing::HasSubstr("right camera"));
  EXPECT_EQ(left->Stats().state, CameraState::kIdle);
}

TEST(CameraPair, DeliversInOrderFromTwoThreads) {
  const auto left = Camera("script:left?recorded=true");
  const auto right = Camera("script:right?recorded=true");
  const auto stereo = MakeCameraPair(left, right);
  Collected collected;
  ASSERT_TRUE(stereo->Start(collected.Sink()).ok());
  EXPECT_TRUE(stereo->Recorded());
  constexpr int kPictures = 2000;
  const auto deliver = [](ScriptedCamera& camera) {
    for (int i = 1; i <= kPictures; ++i) camera.Deliver(i, i * kPeriodNs);
  };
  // Recorded cameras wait for each other, so that no picture is without its partner.
  std::thread left_thread(deliver, std::ref(*left));
  std::thread right_thread(deliver, std::ref(*right));
  left_thread.join();
  right_thread.join();
  ASSERT_EQ(collected.Count(), static_cast<size_t>(kPictures));
  MutexLock lock(collected.mutex);
  for (int i = 0; i < kPictures; ++i) {
    ASSERT_EQ(collected.pairs[i]->left->number, static_cast<uint64_t>(i + 1));
    ASSERT_EQ(collected.pairs[i]->right->number, static_cast<uint64_t>(i + 1));
  }
}

TEST(CameraPair, StopFreesARecordedCameraThatWaitsForTheOther) {
  const auto left = Camera("script:left?recorded=true");
  const auto right = Camera("script:right?recorded=true");
  const auto stereo = MakeCameraPair(left, right);
  Collected collected;
  ASSERT_TRUE(stereo->Start(collected.Sink()).ok());
  std::thread left_thread([&] {
    for (int i = 1; i <= 10; ++i) left->Deliver(i, i * kPeriodNs);
  });
  while (left->Stats().frames < Pairer::kDepth + 1) std::this_thread::yield();
  stereo->Stop();
  left_thread.join();
  EXPECT_EQ(collected.Count(), 0u);
}

}  // namespace
}  // namespace vs::test
