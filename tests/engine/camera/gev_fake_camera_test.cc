// Our driver against the fake camera that comes with Aravis: a device that we did not write.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <thread>

#include "engine/camera/gvcp.h"
#include "tests/engine/camera/camera_watch.h"
#include "tests/support/child_process.h"
#include "tests/support/wait_until.h"

namespace vs::test {
namespace {

using ::testing::Contains;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::SizeIs;
using namespace std::chrono_literals;

constexpr char kUri[] = "gev-ip:127.0.0.1";

size_t OpenFileDescriptors() {
  const std::filesystem::directory_iterator fds("/proc/self/fd");
  return static_cast<size_t>(std::distance(begin(fds), end(fds)));
}

class GevFakeCamera : public testing::Test {
 protected:
  GevFakeCamera() { StartFake(); }

  void StartFake() {
    auto process = ChildProcess::Start({"arv-fake-gv-camera-0.8", "-i", "127.0.0.1", "-s", "GV01"});
    ASSERT_TRUE(process.has_value()) << process.error().ToString();
    fake_ = std::move(*process);
    ASSERT_TRUE(WaitUntil([] { return IdentifyGevCamera("127.0.0.1", 300ms).has_value(); }));
  }

  std::unique_ptr<ChildProcess> fake_;
};

TEST_F(GevFakeCamera, StreamsBySerialNumberAndByAddress) {
  for (const char* uri : {"gev:GV01", kUri}) {
    CameraWatch watch(uri);
    ASSERT_TRUE(watch.Start());
    ASSERT_TRUE(watch.WaitForFrames(50)) << watch.Describe();
    const FramePtr frame = watch.LastFrame();
    EXPECT_EQ(frame->camera, "GV01");
    EXPECT_EQ(frame->image.width(), 512);
    EXPECT_EQ(frame->image.height(), 512);
    EXPECT_GT(frame->capture_ns, 0);
    EXPECT_LE(frame->capture_ns, frame->arrival_ns);
    EXPECT_FALSE(watch.OutOfOrder());
    const CameraStats stats = watch.camera().Stats();
    EXPECT_EQ(stats.state, CameraState::kStreaming);
    EXPECT_EQ(stats.rejected_stale, 0u);
    EXPECT_THAT(stats.model, HasSubstr("Aravis Fake"));
    EXPECT_EQ(stats.packet_bytes, 8192);
    EXPECT_EQ(stats.socket_buffer_asked_bytes, 4 << 20);
    EXPECT_GT(stats.socket_buffer_got_bytes, 0);
  }
}

TEST_F(GevFakeCamera, IsFoundOnTheNetwork) {
  auto cameras = DiscoverGevCameras(2000ms, "GV01");
  ASSERT_TRUE(cameras.has_value()) << cameras.error().ToString();
  ASSERT_THAT(*cameras, SizeIs(1));
  EXPECT_EQ((*cameras)[0].uri, "gev:GV01");
  EXPECT_EQ((*cameras)[0].address, "127.0.0.1");
  EXPECT_EQ((*cameras)[0].model, "Aravis Fake");
}

TEST_F(GevFakeCamera, ListsReadsAndWritesFeaturesWithoutStreaming) {
  CameraWatch watch(kUri);
  const auto features = watch.camera().Features();
  ASSERT_TRUE(features.has_value()) << features.error().ToString();
  EXPECT_THAT(*features, Contains(Field(&FeatureInfo::name, "ExposureTimeAbs")));
  EXPECT_THAT(*features, Contains(Field(&FeatureInfo::name, "TriggerSoftware")));
  for (const FeatureInfo& info : *features) {
    if (info.name == "Width") {
      EXPECT_EQ(info.type, FeatureInfo::Type::kInteger);
      EXPECT_TRUE(info.writable);
      EXPECT_TRUE(info.max.has_value());
    } else if (info.name == "PixelFormat") {
      EXPECT_THAT(info.choices, Contains("Mono8"));
    } else if (info.name == "SensorWidth") {
      EXPECT_FALSE(info.writable);
    }
  }
  EXPECT_EQ(watch.camera().GetFeature("Width"), FeatureValue(int64_t{512}));
  EXPECT_EQ(watch.camera().SetFeature("Width", int64_t{256}), FeatureValue(int64_t{256}));
  EXPECT_EQ(watch.camera().GetFeature("Width"), FeatureValue(int64_t{256}));
  EXPECT_EQ(watch.camera().GetFeature("TriggerMode"), FeatureValue("Off"));
  EXPECT_EQ(watch.camera().Stats().state, CameraState::kIdle);
}

TEST_F(GevFakeCamera, RefusesFeatureValuesThatMakeNoSense) {
  CameraWatch watch(kUri);
  const auto error = [&](const char* name, const FeatureValue& value) {
    const auto set = watch.camera().SetFeature(name, value);
    return set ? Status() : set.error();
  };
  Status status = error("Wdith", int64_t{5});
  EXPECT_EQ(status.code(), StatusCode::kNotFound);
  EXPECT_THAT(status.message(), HasSubstr("no feature \"Wdith\""));
  EXPECT_THAT(error("Exposure", 5.0).message(), HasSubstr("did you mean ExposureTimeAbs"));

  status = error("Width", int64_t{1'000'000});
  EXPECT_EQ(status.code(), StatusCode::kOutOfRange);
  EXPECT_THAT(status.message(), HasSubstr("feature Width: 1000000 is not a whole number from"));

  status = error("Width", "wide");
  EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
  status = error("PixelFormat", "Mono7");
  EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
  EXPECT_THAT(status.message(), HasSubstr("Mono8"));

  status = error("SensorWidth", int64_t{5});
  EXPECT_EQ(status.code(), StatusCode::kFailedPrecondition);
  EXPECT_THAT(status.message(), HasSubstr("cannot be written"));
  // An integer will do for a number.
  EXPECT_TRUE(watch.camera().SetFeature("ExposureTimeAbs", int64_t{7000}).has_value());
}

TEST_F(GevFakeCamera, SetsTheFeaturesOfItsUri) {
  CameraWatch watch(std::string(kUri) + "?Width=320&Height=240&ExposureTimeAbs=3000");
  ASSERT_TRUE(watch.Start());
  ASSERT_TRUE(watch.WaitForFrames(5)) << watch.Describe();
  EXPECT_EQ(watch.LastFrame()->image.width(), 320);
  EXPECT_EQ(watch.LastFrame()->image.height(), 240);
  EXPECT_EQ(watch.LastFrame()->exposure_us, 3000);
}

TEST_F(GevFakeCamera, SaysWhatIsWrongWithTheFeaturesOfItsUri) {
  CameraWatch watch(std::string(kUri) + "?Width=1000000");
  ASSERT_TRUE(watch.Start());
  EXPECT_TRUE(watch.WaitFor([](const CameraStats& stats) {
    return stats.last_error.find("1000000 is not a whole number") != std::string::npos;
  })) << watch.Describe();
}

TEST_F(GevFakeCamera, ChangesThePictureSizeWhileStreaming) {
  CameraWatch watch(kUri);
  ASSERT_TRUE(watch.Start());
  ASSERT_TRUE(watch.WaitForFrames(5)) << watch.Describe();
  ASSERT_TRUE(watch.camera().SetFeature("Width", int64_t{128}).has_value());
  EXPECT_TRUE(WaitUntil([&] { return watch.LastFrame()->image.width() == 128; }))
      << watch.Describe();
  EXPECT_FALSE(watch.OutOfOrder());
  EXPECT_EQ(watch.camera().Stats().reconnects, 0u);
}

TEST_F(GevFakeCamera, TakesAPictureForEachSoftwareTrigger) {
  CameraWatch watch(std::string(kUri) + "?TriggerMode=On&TriggerSource=Software");
  ASSERT_TRUE(watch.Start());
  ASSERT_TRUE(watch.WaitForState(CameraState::kStreaming)) << watch.Describe();
  EXPECT_EQ(watch.Frames(), 0u);
  // This camera sends nothing twice, so on a busy machine a picture may stay incomplete.
  const auto pictures = [&] { return watch.Frames() + watch.camera().Stats().incomplete; };
  for (uint64_t i = 1; i <= 50 && watch.Frames() < 5; ++i) {
    const Status status = watch.camera().Trigger();
    ASSERT_TRUE(status.ok()) << status.ToString();
    ASSERT_TRUE(WaitUntil([&] { return pictures() >= i; })) << watch.Describe();
    EXPECT_EQ(pictures(), i);
  }
  EXPECT_EQ(watch.Frames(), 5u) << watch.Describe();
  EXPECT_EQ(watch.camera().Stats().reconnects, 0u);
}

TEST_F(GevFakeCamera, RefusesATriggerWhileRunningFreely) {
  CameraWatch watch(kUri);
  const Status status = watch.camera().Trigger();
  EXPECT_EQ(status.code(), StatusCode::kFailedPrecondition);
  EXPECT_THAT(status.message(), HasSubstr("set TriggerMode=On"));
}

TEST_F(GevFakeCamera, ComesBackAfterItWasKilledWithItsFeaturesSetAgain) {
  CameraWatch watch(std::string(kUri) + "?Width=320");
  ASSERT_TRUE(watch.Start());
  ASSERT_TRUE(watch.WaitForFrames(5)) << watch.Describe();
  ASSERT_TRUE(watch.camera().SetFeature("Height", int64_t{200}).has_value());
  ASSERT_TRUE(WaitUntil([&] { return watch.LastFrame()->image.height() == 200; }));
  for (uint64_t round = 1; round <= 2; ++round) {
    fake_->Kill();
    ASSERT_TRUE(watch.WaitFor([](const CameraStats& stats) {
      return stats.state != CameraState::kStreaming && stats.frames_per_second == 0;
    })) << watch.Describe();
    StartFake();
    ASSERT_TRUE(watch.WaitFor([&](const CameraStats& stats) {
      return stats.state == CameraState::kStreaming && stats.reconnects == round;
    })) << watch.Describe();
    ASSERT_TRUE(watch.WaitForFrames(5)) << watch.Describe();
    EXPECT_EQ(watch.LastFrame()->image.width(), 320);
    EXPECT_EQ(watch.LastFrame()->image.height(), 200);
    EXPECT_FALSE(watch.OutOfOrder());
  }
}

TEST_F(GevFakeCamera, IsLostWhenItStaysAwayAndNobodyWaitsForIt) {
  CameraWatch watch(kUri);
  ASSERT_TRUE(watch.Start());
  ASSERT_TRUE(watch.WaitForFrames(5)) << watch.Describe();
  fake_->Kill();
  ASSERT_TRUE(watch.WaitForState(CameraState::kStalled)) << watch.Describe();
  // Every call comes back with an answer, whatever the state.
  ASSERT_TRUE(watch.WaitFor([&](const CameraStats& stats) {
    const auto value = watch.camera().GetFeature("Width");
    EXPECT_FALSE(value.has_value());
    if (!value.has_value()) {
      EXPECT_EQ(value.error().code(), StatusCode::kUnavailable) << value.error().message();
    }
    return stats.state == CameraState::kLost;
  })) << watch.Describe();
  EXPECT_THAT(watch.camera().Stats().last_error, testing::Not(testing::IsEmpty()));
}

TEST_F(GevFakeCamera, StallsWhileItIsFrozenAndGoesOn) {
  CameraWatch watch(kUri);
  ASSERT_TRUE(watch.Start());
  ASSERT_TRUE(watch.WaitForFrames(5)) << watch.Describe();
  fake_->Signal(SIGSTOP);
  ASSERT_TRUE(watch.WaitForState(CameraState::kStalled)) << watch.Describe();
  fake_->Signal(SIGCONT);
  ASSERT_TRUE(watch.WaitForState(CameraState::kStreaming)) << watch.Describe();
  EXPECT_TRUE(watch.WaitForFrames(5)) << watch.Describe();
  EXPECT_FALSE(watch.OutOfOrder());
}

TEST_F(GevFakeCamera, ComesBackAfterItWasFrozenForLong) {
  CameraWatch watch(kUri);
  ASSERT_TRUE(watch.Start());
  ASSERT_TRUE(watch.WaitForFrames(5)) << watch.Describe();
  fake_->Signal(SIGSTOP);
  ASSERT_TRUE(watch.WaitForState(CameraState::kLost)) << watch.Describe();
  fake_->Signal(SIGCONT);
  ASSERT_TRUE(watch.WaitForState(CameraState::kStreaming)) << watch.Describe();
  EXPECT_TRUE(watch.WaitForFrames(5)) << watch.Describe();
  EXPECT_EQ(watch.camera().Stats().reconnects, 1u);
}

TEST_F(GevFakeCamera, BelongsToOneClientAndTheSecondIsTold) {
  CameraWatch first(kUri);
  ASSERT_TRUE(first.Start());
  ASSERT_TRUE(first.WaitForFrames(5)) << first.Describe();
  CameraWatch second("gev:GV01");
  ASSERT_TRUE(second.Start());
  ASSERT_TRUE(second.WaitFor([](const CameraStats& stats) {
    return stats.last_error.find("another program controls the camera") != std::string::npos;
  })) << second.Describe();
  EXPECT_EQ(second.camera().GetFeature("Width").error().code(), StatusCode::kFailedPrecondition);
  ASSERT_TRUE(first.WaitForFrames(20)) << first.Describe();
  EXPECT_EQ(first.camera().Stats().reconnects, 0u);
  EXPECT_EQ(first.camera().Stats().rejected_stale, 0u);
  EXPECT_EQ(second.Frames(), 0u);
}

TEST_F(GevFakeCamera, IsWaitedForWhenAnotherClientCrashed) {
  auto other =
      ChildProcess::Start({"arv-camera-test-0.8", "-n", "Aravis-Fake-GV01", "--no-packet-socket"});
  ASSERT_TRUE(other.has_value());
  ASSERT_TRUE(WaitUntil([] {
    return ReadGevRegister("127.0.0.1", kGevControlPrivilege, 300ms).value_or(0) != 0;
  })) << (*other)->Output();
  (*other)->Kill();
  CameraWatch watch(kUri);
  ASSERT_TRUE(watch.Start());
  ASSERT_TRUE(watch.WaitFor([](const CameraStats& stats) {
    return stats.last_error.find("waiting until it lets go") != std::string::npos;
  })) << watch.Describe();
  EXPECT_TRUE(watch.WaitForFrames(5)) << watch.Describe();
}

TEST_F(GevFakeCamera, RunsOutOfBuffersWhenAllPicturesAreHeldAndRecovers) {
  CameraWatch watch(std::string(kUri) + "?buffers=4");
  watch.Hold(true);
  ASSERT_TRUE(watch.Start());
  ASSERT_TRUE(watch.WaitFor([](const CameraStats& stats) { return stats.underruns > 0; }))
      << watch.Describe();
  EXPECT_LE(watch.Held(), 4u);
  EXPECT_EQ(watch.camera().Stats().state, CameraState::kStreaming);
  EXPECT_THAT(watch.camera().Stats().last_error, HasSubstr("buffers=N"));
  watch.Hold(false);
  EXPECT_TRUE(watch.WaitForFrames(20)) << watch.Describe();
  EXPECT_EQ(watch.camera().Stats().reconnects, 0u);
}

TEST_F(GevFakeCamera, PicturesOutliveTheirCamera) {
  FramePtr kept;
  {
    CameraWatch watch(kUri);
    ASSERT_TRUE(watch.Start());
    ASSERT_TRUE(watch.WaitForFrames(3)) << watch.Describe();
    kept = watch.LastFrame();
  }
  uint64_t sum = 0;
  for (int y = 0; y < kept->image.height(); ++y) sum += kept->image.Row(y)[0];
  EXPECT_GT(sum, 0u);
}

TEST_F(GevFakeCamera, CanBeOpenedFiftyTimesWithoutLeavingAnythingOpen) {
  size_t open_before = 0;
  for (int i = 0; i < 50; ++i) {
    {
      CameraWatch watch(kUri);
      ASSERT_TRUE(watch.Start());
      ASSERT_TRUE(watch.WaitForFrames(1)) << i << ": " << watch.Describe();
    }
    if (i == 2) open_before = OpenFileDescriptors();
  }
  EXPECT_EQ(OpenFileDescriptors(), open_before);
}

TEST(GevCamera, ThatIsNotThereIsReportedAndAskedForAgain) {
  CameraWatch watch("gev:99999999");
  ASSERT_TRUE(watch.Start());
  ASSERT_TRUE(watch.WaitFor([](const CameraStats& stats) {
    return stats.last_error.find("no camera with serial number 99999999 answers") !=
           std::string::npos;
  })) << watch.Describe();
  EXPECT_EQ(watch.camera().Stats().state, CameraState::kOpening);
  const auto features = watch.camera().Features();
  ASSERT_FALSE(features.has_value());
  EXPECT_EQ(features.error().code(), StatusCode::kUnavailable);
}

TEST(GevCamera, RefusesAddressesAndOptionsThatMakeNoSense) {
  EXPECT_EQ(IdentifyGevCamera("300.1.1.1", 100ms).error().code(), StatusCode::kInvalidArgument);
  const auto bad = CameraDrivers::Get().Make(CameraUri::Parse("gev:1?buffers=1&speed=9").value());
  ASSERT_FALSE(bad.has_value());
  EXPECT_THAT(bad.error().faults(), SizeIs(2));
}

}  // namespace
}  // namespace vs::test
