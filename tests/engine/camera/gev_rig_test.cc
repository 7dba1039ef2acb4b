// Our driver against the simulated stereo rig: real packets, real losses, real unplugging.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "engine/base/str.h"
#include "engine/camera/camera_hub.h"
#include "engine/camera/gvcp.h"
#include "engine/camera/stereo_source.h"
#include "engine/sim/device_clock.h"
#include "tests/engine/camera/camera_watch.h"
#include "tests/support/count_allocations.h"
#include "tests/support/gevsim.h"
#include "tests/support/wait_until.h"

namespace vs::test {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::SizeIs;
using namespace std::chrono_literals;

// Small pictures, so that even a busy machine renders both of every pair in time.
constexpr char kTriggered[] = "Width=64&Height=48&TriggerMode=On&TriggerSource=Line1";
constexpr char kFree[] = "BinningHorizontal=2&BinningVertical=2";

std::string Left(const std::string& options) { return "gev:21000001?" + options; }
std::string Right(const std::string& options) { return "gev:21000002?" + options; }

class GevRig : public testing::Test {
 protected:
  void StartRig(std::vector<std::string> options = {}) {
    options.insert(options.end(), {"--noise", "0"});
    auto rig = StartGevSim(options);
    ASSERT_TRUE(rig.has_value()) << rig.error().ToString();
    rig_ = std::move(*rig);
  }

  std::unique_ptr<ChildProcess> rig_;
};

// Pairs of the rig's two cameras, and whether any of them is wrong.
class PairWatch {
 public:
  PairWatch(const std::string& left, const std::string& right, sim::DeviceClock left_clock = {},
            sim::DeviceClock right_clock = {})
      : left_clock_(left_clock), right_clock_(right_clock) {
    source_ = MakeCameraPair(hub_.Acquire(CameraUri::Parse(left).value()).value(),
                             hub_.Acquire(CameraUri::Parse(right).value()).value());
    const Status status = source_->Start([this](const StereoFramePtr& pair) { Take(*pair); });
    EXPECT_TRUE(status.ok()) << status.ToString();
  }
  ~PairWatch() { source_->Stop(); }

  bool WaitForPairs(uint64_t more) {
    const uint64_t wanted = Pairs() + more;
    return WaitUntil([&] { return Pairs() >= wanted; });
  }
  uint64_t Pairs() {
    MutexLock lock(mutex_);
    return pairs_;
  }
  // Pairs whose pictures were triggered at different instants.
  uint64_t WrongPairs() {
    MutexLock lock(mutex_);
    return wrong_;
  }
  StereoStats Stats() { return source_->Stats(); }
  // For the message of a failed assertion.
  std::string Describe() {
    const StereoStats s = Stats();
    const auto side = [](const CameraStats& camera, const Unpaired& unpaired) {
      return Str(CameraStateName(camera.state), " \"", camera.last_error, "\", frames ",
                 camera.frames, ", lost ", camera.lost, ", incomplete ", camera.incomplete,
                 ", unpaired ", unpaired.no_counterpart, " + ", unpaired.overflow, " + ",
                 unpaired.out_of_order);
    };
    return Str("left ", side(s.left, s.pairing.left), "; right ", side(s.right, s.pairing.right),
               "; pairs ", s.pairing.pairs, ", tolerance ", s.pairing.tolerance_ns,
               " ns, skew p99 ", s.pairing.skew_p99_ns, " ns");
  }

 private:
  void Take(const StereoFrame& pair) {
    const int64_t apart_ns = left_clock_.InstantOf(pair.left->timestamp_ns) -
                             right_clock_.InstantOf(pair.right->timestamp_ns);
    MutexLock lock(mutex_);
    ++pairs_;
    if (std::abs(apart_ns) > 1'000'000) ++wrong_;
  }

  CameraHub hub_;
  const sim::DeviceClock left_clock_;
  const sim::DeviceClock right_clock_;
  Mutex mutex_;
  uint64_t pairs_ VS_GUARDED_BY(mutex_) = 0;
  uint64_t wrong_ VS_GUARDED_BY(mutex_) = 0;
  std::unique_ptr<StereoSource> source_;
};

TEST_F(GevRig, IsFoundWithBothCameras) {
  StartRig();
  CameraHub hub;
  ASSERT_TRUE(WaitUntil([&] { return hub.Discover(300ms).value().size() == 2; }));
  const auto cameras = hub.Discover(300ms).value();
  EXPECT_THAT(cameras, Contains(AllOf(Field(&FoundCamera::serial, "21000001"),
                                      Field(&FoundCamera::address, "127.0.0.1"),
                                      Field(&FoundCamera::model, "Basler acA1300-30gm"))));
  EXPECT_THAT(cameras, Contains(Field(&FoundCamera::address, "127.0.0.2")));
}

// Block ids start at 65500, so they wrap within this test; the clocks are seconds apart and drift.
TEST_F(GevRig, IsPairedByTimeWhateverItsClocksShow) {
  StartRig({"--right-offset-ms", "3000", "--left-drift-ppm", "100", "--right-drift-ppm", "-100"});
  PairWatch watch(Left(kTriggered), Right(kTriggered), {.drift_ppm = 100},
                  {.offset_ns = 3'000'000'000, .drift_ppm = -100});
  ASSERT_TRUE(watch.WaitForPairs(120)) << watch.Describe();
  EXPECT_EQ(watch.WrongPairs(), 0u);
  const StereoStats stats = watch.Stats();
  EXPECT_EQ(stats.left.rejected_stale, 0u);
  EXPECT_EQ(stats.right.rejected_stale, 0u);
  EXPECT_EQ(stats.left.model, "Basler acA1300-30gm");
  EXPECT_FALSE(stats.pairing.by_trigger);
}

TEST_F(GevRig, KeepsPairsRightWhenWholePicturesAreLost) {
  StartRig({"--fault", "right drop-frames 0.3"});
  PairWatch watch(Left(kTriggered), Right(kTriggered));
  ASSERT_TRUE(watch.WaitForPairs(60)) << watch.Describe();
  EXPECT_EQ(watch.WrongPairs(), 0u);
  const StereoStats stats = watch.Stats();
  EXPECT_GT(stats.right.lost, 0u);
  EXPECT_GT(stats.pairing.left.no_counterpart, 0u);
}

// Of 40 packets a picture, one in 50 is lost: without resend, 20 whole pictures in a row would come
// once in ten million times.
TEST_F(GevRig, MendsLostPacketsByAskingForThemAgain) {
  StartRig({"--only", "left", "--fault", "drop 0.02"});
  CameraWatch watch(Left(kFree));
  ASSERT_TRUE(watch.Start());
  ASSERT_TRUE(WaitUntil([&] { return watch.GaplessFrames() >= 20; })) << watch.Describe();
  const CameraStats stats = watch.camera().Stats();
  EXPECT_GT(stats.resend_requests, 0u);
  EXPECT_GT(stats.resent, 0u);
  EXPECT_FALSE(watch.OutOfOrder());
}

TEST_F(GevRig, LosesPicturesWithoutResend) {
  StartRig({"--only", "left", "--fault", "drop 0.02"});
  CameraWatch watch(Left(std::string(kFree) + "&resend=false"));
  ASSERT_TRUE(watch.Start());
  ASSERT_TRUE(watch.WaitFor([](const CameraStats& stats) {
    return stats.incomplete + stats.lost > 20 && stats.frames > 0;
  })) << watch.Describe();
  EXPECT_EQ(watch.camera().Stats().resend_requests, 0u);
}

// The receiver hands out recycled pictures when it sees a payload that it does not know.
TEST_F(GevRig, NeverLetsAStalePicturePass) {
  StartRig({"--only", "left", "--fault", "payload-type 6 10"});
  CameraWatch watch(Left(kFree));
  ASSERT_TRUE(watch.Start());
  ASSERT_TRUE(watch.WaitForFrames(100)) << watch.Describe();
  EXPECT_FALSE(watch.OutOfOrder());
  const CameraStats stats = watch.camera().Stats();
  // One for each injected picture; a busy machine may miss one altogether.
  EXPECT_GE(stats.rejected_stale, 8u) << watch.Describe();
  EXPECT_LE(stats.rejected_stale, (stats.frames + stats.lost) / 10 + 1) << watch.Describe();
}

TEST_F(GevRig, ComesBackAsAPairWhenItWasKilledAndStartedAgain) {
  StartRig();
  PairWatch watch(Left(kTriggered), Right(kTriggered));
  ASSERT_TRUE(watch.WaitForPairs(10)) << watch.Describe();
  rig_->Kill();
  ASSERT_TRUE(WaitUntil([&] {
    const StereoStats stats = watch.Stats();
    return stats.left.state != CameraState::kStreaming &&
           stats.right.state != CameraState::kStreaming;
  }));
  StartRig();
  ASSERT_TRUE(WaitUntil([&] {
    const StereoStats stats = watch.Stats();
    return stats.left.reconnects == 1 && stats.right.reconnects == 1;
  }));
  ASSERT_TRUE(watch.WaitForPairs(10)) << watch.Describe();
  EXPECT_EQ(watch.WrongPairs(), 0u);
}

TEST_F(GevRig, TakesPicturesBySoftwareTrigger) {
  StartRig({"--only", "left"});
  CameraWatch watch(Left("TriggerMode=On&TriggerSource=Software"));
  ASSERT_TRUE(watch.Start());
  ASSERT_TRUE(watch.WaitForState(CameraState::kStreaming)) << watch.Describe();
  for (uint64_t i = 1; i <= 5; ++i) {
    // The sensor ignores a trigger that comes too soon after the one before.
    ASSERT_TRUE(WaitUntil([&] {
      EXPECT_TRUE(watch.camera().Trigger().ok());
      return watch.Frames() >= i;
    })) << watch.Describe();
  }
  EXPECT_EQ(watch.LastFrame()->image.width(), 1296);
  EXPECT_EQ(watch.LastFrame()->image.height(), 966);
}

TEST_F(GevRig, BelongsToOneClient) {
  StartRig({"--only", "left"});
  CameraWatch first(Left(kFree));
  ASSERT_TRUE(first.Start());
  ASSERT_TRUE(first.WaitForFrames(5)) << first.Describe();
  CameraWatch second(Left(kFree));
  ASSERT_TRUE(second.Start());
  ASSERT_TRUE(second.WaitFor([](const CameraStats& stats) {
    return stats.last_error.find("another program controls the camera") != std::string::npos;
  })) << second.Describe();
  ASSERT_TRUE(first.WaitForFrames(20)) << first.Describe();
  EXPECT_EQ(first.camera().Stats().reconnects, 0u);
  CameraHub hub;
  EXPECT_TRUE(WaitUntil([&] { return hub.Discover(300ms).value().size() == 1; }))
      << "one in use is found, too";
}

TEST_F(GevRig, ListsItsFeaturesWhileItStreams) {
  StartRig({"--only", "left"});
  CameraWatch watch(Left(kFree));
  ASSERT_TRUE(watch.Start());
  ASSERT_TRUE(watch.WaitForFrames(5)) << watch.Describe();
  const auto features = watch.camera().Features();
  ASSERT_TRUE(features.has_value()) << features.error().ToString();
  for (const char* name : {"Width", "ExposureTimeAbs", "GainRaw", "TriggerSoftware", "PixelFormat",
                           "AcquisitionFrameRateAbs", "BinningHorizontal"}) {
    EXPECT_THAT(*features, Contains(Field(&FeatureInfo::name, name)));
  }
  ASSERT_TRUE(watch.camera().SetFeature("ExposureTimeAbs", 4000.0).has_value());
  EXPECT_TRUE(WaitUntil([&] { return watch.LastFrame()->exposure_us == 4000; }));
  // Locked while it streams: the stream is stopped for the moment.
  const auto set = watch.camera().SetFeature("BinningHorizontal", int64_t{1});
  ASSERT_TRUE(set.has_value()) << set.error().ToString();
  EXPECT_TRUE(WaitUntil([&] { return watch.LastFrame()->image.width() == 1296; }))
      << watch.Describe();
  EXPECT_EQ(watch.camera().Stats().reconnects, 0u);
}

TEST_F(GevRig, StreamsWithoutAskingTheHeap) {
  StartRig({"--only", "left"});
  CameraWatch watch(Left(kFree));
  ASSERT_TRUE(watch.Start());
  ASSERT_TRUE(watch.WaitForFrames(40)) << watch.Describe();
  // On a busy machine more frames than ever may be under way, which takes memory once. What takes
  // some for each frame, however, never lets 20 frames pass without.
  EXPECT_TRUE(WaitUntil([&] {
    const uint64_t before = Allocations();
    return watch.WaitForFrames(20) && Allocations() == before;
  })) << watch.Describe();
}

}  // namespace
}  // namespace vs::test
