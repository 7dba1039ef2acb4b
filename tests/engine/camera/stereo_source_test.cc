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

TEST(StereoReport, TellsThePairingAndTheUnpairedPicturesOfEachSideByReason) {
  StereoStats stats;
  stats.left.frames = 20;
  stats.right.incomplete = 3;
  stats.pairing = {.pairs = 12,
                   .left = {.no_counterpart = 1, .overflow = 2, .out_of_order = 3},
                   .right = {.no_counterpart = 4, .overflow = 5, .out_of_order = 6},
                   .tolerance_ns = 5'000'000,
                   .skew_p50_ns = 125'000,
                   .skew_p99_ns = 250'000,
                   .skew_max_ns = 500'000};
  const SourceReport report = ReportOf(stats);
  EXPECT_EQ(report.problem, "");
  EXPECT_THAT(
      report.readings,
      testing::ElementsAre(
          Reading{"left_frames", int64_t{20}}, Reading{"left_incomplete", int64_t{0}},
          Reading{"left_lost", int64_t{0}}, Reading{"right_frames", int64_t{0}},
          Reading{"right_incomplete", int64_t{3}}, Reading{"right_lost", int64_t{0}},
          Reading{"pairs", int64_t{12}}, Reading{"left_no_counterpart", int64_t{1}},
          Reading{"left_overflow", int64_t{2}}, Reading{"left_out_of_order", int64_t{3}},
          Reading{"right_no_counterpart", int64_t{4}}, Reading{"right_overflow", int64_t{5}},
          Reading{"right_out_of_order", int64_t{6}}, Reading{"by_trigger", false},
          Reading{"tolerance_ms", 5.0}, Reading{"skew_p50_ms", 0.125}, Reading{"skew_p99_ms", 0.25},
          Reading{"skew_max_ms", 0.5}));
}

TEST(StereoReport, NamesTheCameraThatHasAProblem) {
  StereoStats stats;
  stats.right.last_error = "the camera does not answer";
  EXPECT_EQ(ReportOf(stats).problem, "right camera: the camera does not answer");
  stats.left.state = CameraState::kStalled;
  EXPECT_EQ(ReportOf(stats).problem, "left camera: no pictures come");
}

TEST(StereoReport, NamesTheCameraThatIsSilentThoughItClaimsToBeWell) {
  const auto left = Camera("script:left");
  const auto right = Camera("script:right");
  const auto stereo = MakeCameraPair(left, right);
  Collected collected;
  ASSERT_TRUE(stereo->Start(collected.Sink()).ok());
  // Four wait, then twelve are alone.
  for (int i = 1; i <= 15; ++i) left->Deliver(i, i * kPeriodNs);
  EXPECT_EQ(ReportOf(stereo->Stats()).problem, "");
  left->Deliver(16, 16 * kPeriodNs);
  EXPECT_THAT(ReportOf(stereo->Stats()).problem,
              testing::StartsWith("right camera: no pictures come"));
  right->Deliver(16, 16 * kPeriodNs);
  EXPECT_EQ(ReportOf(stereo->Stats()).problem, "") << "a pair was found";
  for (int i = 17; i <= 32; ++i) right->Deliver(i, i * kPeriodNs);
  EXPECT_THAT(ReportOf(stereo->Stats()).problem,
              testing::StartsWith("left camera: no pictures come"));
}

TEST(StereoReport, SaysThatTheCamerasAreNotTriggeredTogether) {
  const auto left = Camera("script:left");
  const auto right = Camera("script:right");
  const auto stereo = MakeCameraPair(left, right);
  Collected collected;
  ASSERT_TRUE(stereo->Start(collected.Sink()).ok());
  for (int i = 1; i <= 8; ++i) {
    left->Deliver(i, i * kPeriodNs);
    right->Deliver(i, i * kPeriodNs + kPeriodNs / 2);
  }
  EXPECT_EQ(collected.Count(), 0u);
  EXPECT_THAT(ReportOf(stereo->Stats()).problem, testing::HasSubstr("trigger both together"));
}

}  // namespace
}  // namespace vs::test
