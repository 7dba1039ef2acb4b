#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <vector>

#include "engine/base/clock.h"
#include "engine/base/mutex.h"
#include "engine/camera/camera_source.h"
#include "engine/sim/demo_rig.h"
#include "engine/sim/scene_camera.h"
#include "tests/support/wait_until.h"

namespace vs::sim {
namespace {

using testing::HasSubstr;

// Keeps the pictures that a camera delivers.
class Album {
 public:
  FrameSink Sink() {
    return [this](FramePtr frame) {
      MutexLock lock(mutex_);
      frames_.push_back(std::move(frame));
    };
  }
  std::vector<FramePtr> Frames() const {
    MutexLock lock(mutex_);
    return frames_;
  }
  bool WaitFor(size_t count) const {
    return test::WaitUntil([this, count] { return Frames().size() >= count; });
  }

 private:
  mutable Mutex mutex_;
  std::vector<FramePtr> frames_ VS_GUARDED_BY(mutex_);
};

Result<std::unique_ptr<CameraSource>> Make(const std::string& uri) {
  const auto parsed = CameraUri::Parse(uri);
  if (!parsed) return parsed.error();
  return CameraDrivers::Get().Make(*parsed);
}

std::unique_ptr<CameraSource> MustMake(const std::string& uri) {
  auto camera = Make(uri);
  EXPECT_TRUE(camera.has_value()) << camera.error().ToString();
  return camera ? std::move(*camera) : nullptr;
}

TEST(SimCamera, BothSidesTakeTheirPicturesAtTheSameInstants) {
  const auto left = MustMake("sim:demo#left?fps=3&binning=4");
  const auto right = MustMake("sim:demo#right?fps=3&binning=4");
  Album left_album;
  Album right_album;
  ASSERT_TRUE(left->Start(left_album.Sink()).ok());
  ASSERT_TRUE(right->Start(right_album.Sink()).ok());
  size_t common = 0;
  EXPECT_TRUE(test::WaitUntil([&] {
    std::map<uint64_t, int64_t> instants;
    for (const FramePtr& frame : left_album.Frames()) instants[frame->trigger] = frame->capture_ns;
    common = 0;
    for (const FramePtr& frame : right_album.Frames()) {
      const auto found = instants.find(frame->trigger);
      if (found == instants.end()) continue;
      EXPECT_EQ(found->second, frame->capture_ns);
      ++common;
    }
    return common >= 3;
  }));
  left->Stop();
  right->Stop();
  const size_t after_stop = left_album.Frames().size();
  EXPECT_EQ(left->Stats().frames, after_stop);
  EXPECT_EQ(left->Stats().state, CameraState::kIdle);
}

TEST(SimCamera, ShowsTheSceneOfItsTimestamp) {
  const auto camera = MustMake("sim:demo#right?binning=2&ideal=true&seed=9&ExposureTimeAbs=7000");
  Album album;
  ASSERT_TRUE(camera->Start(album.Sink()).ok());
  ASSERT_TRUE(album.WaitFor(1));
  camera->Stop();
  const FramePtr frame = album.Frames().front();
  ASSERT_EQ(frame->image.width(), 648);
  ASSERT_EQ(frame->image.height(), 483);
  EXPECT_EQ(frame->exposure_us, 7000);
  EXPECT_EQ(frame->number, 1u);
  EXPECT_LE(frame->capture_ns, frame->arrival_ns);

  BufferPool pool;
  SceneCamera scene({.rig = IdealRig(), .side = Side::kRight, .noise = {1, 9}});
  SensorSettings settings = scene.DefaultSettings();
  settings.binning_x = settings.binning_y = 2;
  settings.width = 648;
  settings.height = 483;
  settings.exposure_us = 7000;
  GreyImage expected(pool, 648, 483);
  scene.Capture(frame->timestamp_ns, settings, expected);
  EXPECT_EQ(std::memcmp(expected.Row(0), frame->image.Row(0), size_t{648} * 483), 0);
}

TEST(SimCamera, TakesOnePictureForEachSoftwareTrigger) {
  const auto camera = MustMake("sim:demo#left?binning=4&TriggerMode=On");
  Album album;
  ASSERT_TRUE(camera->Start(album.Sink()).ok());
  for (size_t i = 1; i <= 3; ++i) {
    ASSERT_TRUE(i == 2 ? camera->SetFeature("TriggerSoftware", true).has_value()
                       : camera->Trigger().ok());
    ASSERT_TRUE(album.WaitFor(i));
  }
  camera->Stop();
  EXPECT_EQ(album.Frames().size(), 3u);
  EXPECT_EQ(album.Frames().back()->number, 3u);
  EXPECT_EQ(album.Frames().back()->trigger, 0u);
}

TEST(SimCamera, RefusesASoftwareTriggerThatItDoesNotWaitFor) {
  const auto camera = MustMake("sim:demo#left");
  EXPECT_EQ(camera->Trigger().code(), StatusCode::kFailedPrecondition);
  EXPECT_EQ(camera->SetFeature("TriggerSoftware", true).error().code(),
            StatusCode::kFailedPrecondition);
}

TEST(SimCamera, CountsPulsesThatItWasTooBusyFor) {
  const auto camera = MustMake("sim:demo#left?fps=200&binning=4");
  const SystemClock clock;
  Album album;
  // The first picture is held for ten periods.
  ASSERT_TRUE(camera
                  ->Start([&, keep = album.Sink()](const FramePtr& frame) {
                    EXPECT_TRUE(frame->number > 1 || test::WaitUntil([&] {
                                  return clock.MonotonicNs() > frame->capture_ns + 50'000'000;
                                }));
                    keep(frame);
                  })
                  .ok());
  ASSERT_TRUE(album.WaitFor(2));
  camera->Stop();
  const auto frames = album.Frames();
  EXPECT_GE(frames[1]->number, 10u);
  EXPECT_GE(camera->Stats().lost, 9u);
  for (size_t i = 1; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i]->number - frames[i - 1]->number,
              frames[i]->trigger - frames[i - 1]->trigger);
  }
}

TEST(SimCamera, CanBeStoppedAndStartedAgain) {
  const auto camera = MustMake("sim:demo#left?binning=4");
  for (int i = 0; i < 2; ++i) {
    Album album;
    ASSERT_TRUE(camera->Start(album.Sink()).ok());
    EXPECT_EQ(camera->Start(album.Sink()).code(), StatusCode::kFailedPrecondition);
    EXPECT_TRUE(album.WaitFor(1));
    camera->Stop();
    EXPECT_EQ(album.Frames().front()->number, 1u);
  }
}

TEST(SimCamera, ExplainsItsFeatures) {
  const auto camera = MustMake("sim:demo#left?binning=2");
  const auto features = camera->Features();
  ASSERT_TRUE(features.has_value());
  for (const FeatureInfo& info : *features) {
    EXPECT_FALSE(info.description.empty()) << info.name;
    EXPECT_TRUE(camera->GetFeature(info.name).has_value()) << info.name;
    const bool is_number =
        info.type == FeatureInfo::Type::kInteger || info.type == FeatureInfo::Type::kFloat;
    EXPECT_EQ(info.min.has_value() && info.max.has_value(), is_number) << info.name;
  }
  EXPECT_EQ(*camera->GetFeature("Width"), FeatureValue(int64_t{648}));
  EXPECT_EQ(*camera->GetFeature("DeviceID"), FeatureValue(std::string("demo#left")));
}

TEST(SimCamera, StoresWhatIsInRangeAndRefusesTheRest) {
  const auto camera = MustMake("sim:demo#left");
  const auto code = [&](const std::string& name, const FeatureValue& value) {
    const auto stored = camera->SetFeature(name, value);
    return stored ? StatusCode::kOk : stored.error().code();
  };
  EXPECT_EQ(*camera->SetFeature("ExposureTimeAbs", 1234.5), FeatureValue(1234.5));
  EXPECT_EQ(*camera->SetFeature("GainRaw", int64_t{40}), FeatureValue(int64_t{40}));
  EXPECT_EQ(*camera->SetFeature("TriggerMode", std::string("On")), FeatureValue(std::string("On")));
  EXPECT_EQ(code("ExposureTimeAbs", int64_t{20}), StatusCode::kOk);
  EXPECT_EQ(code("ExposureTimeAbs", 15.0), StatusCode::kOutOfRange);
  EXPECT_EQ(code("GainRaw", int64_t{501}), StatusCode::kOutOfRange);
  EXPECT_EQ(code("GainRaw", 1.5), StatusCode::kInvalidArgument);
  EXPECT_EQ(code("GainRaw", std::string("high")), StatusCode::kInvalidArgument);
  EXPECT_EQ(code("TriggerMode", std::string("Maybe")), StatusCode::kInvalidArgument);
  EXPECT_EQ(code("DeviceID", std::string("7")), StatusCode::kFailedPrecondition);
  EXPECT_EQ(code("Depth", 1.0), StatusCode::kNotFound);
  EXPECT_THAT(camera->SetFeature("ExposureTimeAbs", 1e9).error().message(),
              HasSubstr("from 16 to 1e+07 us"));
}

TEST(SimCamera, KeepsTheSizeOfItsPicturesWhileItStreams) {
  const auto camera = MustMake("sim:demo#left?binning=4");
  Album album;
  ASSERT_TRUE(camera->Start(album.Sink()).ok());
  EXPECT_EQ(camera->SetFeature("Width", int64_t{100}).error().code(),
            StatusCode::kFailedPrecondition);
  EXPECT_TRUE(camera->SetFeature("ExposureTimeAbs", 500.0).has_value());
  camera->Stop();
  EXPECT_TRUE(camera->SetFeature("Width", int64_t{100}).has_value());
  EXPECT_TRUE(camera->SetFeature("OffsetX", int64_t{224}).has_value());
  EXPECT_EQ(camera->SetFeature("OffsetX", int64_t{225}).error().code(), StatusCode::kOutOfRange);
}

TEST(SimCamera, RefusesAddressesThatMakeNoSense) {
  const std::pair<const char*, const char*> wrong[] = {
      {"sim:demo#middle", "demo#left and demo#right"},
      {"sim:moon#left", "demo#left and demo#right"},
      {"sim:demo#left?fps=0", "fps"},
      {"sim:demo#left?binning=5", "binning"},
      {"sim:demo#left?colour=red", "colour"},
      {"sim:demo#left?GainRaw=loud", "GainRaw"},
      {"sim:demo#left?Width=1297", "Width"},
  };
  for (const auto& [uri, expected] : wrong) {
    const auto camera = Make(uri);
    ASSERT_FALSE(camera.has_value()) << uri;
    EXPECT_THAT(camera.error().ToString(), HasSubstr(expected));
  }
}

}  // namespace
}  // namespace vs::sim
