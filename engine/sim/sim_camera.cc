// The driver "sim": a camera of the simulated rig inside this process, such as sim:demo#left.
#include <algorithm>
#include <array>
#include <chrono>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

#include "engine/base/clock.h"
#include "engine/base/mutex.h"
#include "engine/base/recycler.h"
#include "engine/base/str.h"
#include "engine/camera/camera_source.h"
#include "engine/sim/camera_features.h"
#include "engine/sim/demo_rig.h"
#include "engine/sim/scene_camera.h"

namespace vs::sim {
namespace {

constexpr int64_t kNsPerSecond = 1'000'000'000;
// As of gevsim's right camera.
constexpr double kRightSensitivity = 1.03;

// Takes pictures at whole multiples of the picture period on the monotonic clock, so that two
// cameras of one rate take theirs at the same instants, with the same trigger numbers.
class SimCamera final : public CameraSource {
 public:
  SimCamera(const SceneCamera::Settings& settings, CameraFeatures features, std::string name)
      : settings_(settings), name_(std::move(name)), features_(std::move(features)) {}
  ~SimCamera() override { StopThread(); }

  Status Start(FrameSink sink) override {
    MutexLock lock(mutex_);
    if (running_) return FailedPrecondition("camera " + name_ + " is streaming already");
    running_ = true;
    number_ = 0;
    thread_ = std::thread([this, sink = std::move(sink)] { Run(sink); });
    return {};
  }
  void Stop() override { StopThread(); }

  Status Trigger() override {
    MutexLock lock(mutex_);
    if (!features_.waits_for_trigger()) {
      return FailedPrecondition(
          "camera " + name_ + " is not set to software trigger: " + "set TriggerMode to On first");
    }
    triggered_ = true;
    changed_.NotifyAll();
    return {};
  }

  Result<std::vector<FeatureInfo>> Features() override {
    MutexLock lock(mutex_);
    return features_.List();
  }
  Result<FeatureValue> GetFeature(const std::string& name) override {
    MutexLock lock(mutex_);
    return features_.Get(name);
  }
  Result<FeatureValue> SetFeature(const std::string& name, const FeatureValue& value) override {
    if (name == "TriggerSoftware") VS_RETURN_IF_ERROR(Trigger());
    MutexLock lock(mutex_);
    auto stored = features_.Set(name, value, running_);
    changed_.NotifyAll();
    return stored;
  }

  CameraStats Stats() const override {
    MutexLock lock(mutex_);
    CameraStats stats = stats_;
    stats.state = running_ ? CameraState::kStreaming : CameraState::kIdle;
    stats.model = "VisionServer simulated camera";
    stats.serial = name_;
    const int64_t second_ago_ns = clock_.MonotonicNs() - kNsPerSecond;
    stats.frames_per_second = static_cast<double>(
        std::count_if(recent_ns_.begin(), recent_ns_.end(),
                      [second_ago_ns](int64_t taken_ns) { return taken_ns > second_ago_ns; }));
    return stats;
  }

 private:
  struct Shot {
    int64_t instant_ns;
    uint64_t trigger;  // 0 for a software trigger, which the other camera knows nothing of
    SensorSettings sensor;
  };

  void StopThread() {
    {
      MutexLock lock(mutex_);
      running_ = false;
      changed_.NotifyAll();
    }
    if (thread_.joinable()) thread_.join();
  }

  void Run(const FrameSink& sink) {
    // The still part of the scene takes a moment to render, which must not hold up the caller.
    if (camera_ == nullptr) camera_ = std::make_unique<SceneCamera>(settings_);
    while (const auto shot = NextShot()) sink(Take(*shot));
  }

  // Waits for the next picture's instant; nothing once the camera is stopped.
  std::optional<Shot> NextShot() VS_EXCLUDES(mutex_) {
    MutexLock lock(mutex_);
    while (running_) {
      const int64_t now_ns = clock_.MonotonicNs();
      int64_t wait_ns = kNsPerSecond;
      if (features_.waits_for_trigger()) {
        last_pulse_ = 0;
        if (std::exchange(triggered_, false)) return Shot{now_ns, 0, features_.sensor()};
      } else {
        const auto period_ns = static_cast<int64_t>(kNsPerSecond / features_.frame_rate_hz());
        const int64_t pulse = now_ns / period_ns;
        if (last_pulse_ == 0) last_pulse_ = pulse;
        if (pulse > last_pulse_) {
          CountMissed(pulse - last_pulse_ - 1);
          last_pulse_ = pulse;
          return Shot{pulse * period_ns, static_cast<uint64_t>(pulse), features_.sensor()};
        }
        wait_ns = (pulse + 1) * period_ns - now_ns;
      }
      changed_.WaitFor(mutex_, std::chrono::nanoseconds(wait_ns));
    }
    return std::nullopt;
  }

  // Pulses that came while a picture was still being taken or handed on.
  void CountMissed(int64_t pulses) VS_REQUIRES(mutex_) {
    if (number_ == 0 || pulses <= 0) return;
    number_ += static_cast<uint64_t>(pulses);
    stats_.lost += static_cast<uint64_t>(pulses);
  }

  FramePtr Take(const Shot& shot) VS_EXCLUDES(mutex_) {
    auto frame = std::allocate_shared<Frame>(frame_memory_);
    frame->image = GreyImage(pool_, shot.sensor.width, shot.sensor.height);
    camera_->Capture(shot.instant_ns, shot.sensor, frame->image);
    frame->camera = name_;
    frame->trigger = shot.trigger;
    frame->timestamp_ns = shot.instant_ns;
    frame->capture_ns = shot.instant_ns;
    frame->arrival_ns = clock_.MonotonicNs();
    frame->exposure_us = shot.sensor.exposure_us;
    MutexLock lock(mutex_);
    frame->number = ++number_;
    ++stats_.frames;
    recent_ns_[stats_.frames % recent_ns_.size()] = frame->arrival_ns;
    return frame;
  }

  const SceneCamera::Settings settings_;
  const std::string name_;
  const SystemClock clock_;
  BufferPool pool_;
  Recycler<Frame> frame_memory_;
  std::unique_ptr<SceneCamera> camera_;  // of the thread
  std::thread thread_;

  mutable Mutex mutex_;
  CondVar changed_;
  bool running_ VS_GUARDED_BY(mutex_) = false;
  bool triggered_ VS_GUARDED_BY(mutex_) = false;
  int64_t last_pulse_ VS_GUARDED_BY(mutex_) = 0;  // 0: none yet
  uint64_t number_ VS_GUARDED_BY(mutex_) = 0;     // of the last picture
  CameraFeatures features_ VS_GUARDED_BY(mutex_);
  CameraStats stats_ VS_GUARDED_BY(mutex_);
  std::array<int64_t, 1024> recent_ns_ VS_GUARDED_BY(mutex_) = {};  // when pictures were taken
};

Result<Side> SideOf(const CameraUri& uri) {
  if (uri.address == "demo#left") return Side::kLeft;
  if (uri.address == "demo#right") return Side::kRight;
  return NotFound(Str("there is no simulated camera \"", uri.address,
                      "\"; there are demo#left and demo#right"));
}

Result<std::unique_ptr<CameraSource>> MakeSimCamera(const CameraUri& uri) {
  VS_ASSIGN_OR_RETURN(const Side side, SideOf(uri));
  UriOptions options(uri);
  const double fps = options.Number("fps", 30, 0.1, 1000);
  const int64_t binning = options.Integer("binning", 1, 1, kMaxBinning);
  const double noise = options.Number("noise", 1, 0, 100);
  const int64_t seed = options.Integer("seed", 1, 0, int64_t{1} << 53);
  const bool ideal = options.Flag("ideal", false);
  VS_RETURN_IF_ERROR(options.Check());

  const StereoRig rig = ideal ? IdealRig() : DemoRig();
  CameraFeatures features(rig.left.width, rig.left.height, uri.address);
  CameraUri::Options wanted = {{"AcquisitionFrameRateAbs", Str(fps)},
                               {"BinningHorizontal", Str(binning)},
                               {"BinningVertical", Str(binning)}};
  const CameraUri::Options given = uri.Features();
  wanted.insert(wanted.end(), given.begin(), given.end());
  for (const auto& [name, text] : wanted) {
    if (const auto stored = features.SetText(name, text); !stored) {
      return stored.error().Annotated("camera " + uri.ToString());
    }
  }
  const bool brighter = side == Side::kRight && !ideal;
  return std::unique_ptr<CameraSource>(std::make_unique<SimCamera>(
      SceneCamera::Settings{.rig = rig,
                            .side = side,
                            .sensitivity = brighter ? kRightSensitivity : 1.0,
                            .noise = {noise, static_cast<uint64_t>(seed)}},
      std::move(features), "sim:" + uri.address));
}

VS_REGISTER_CAMERA("sim", MakeSimCamera);

}  // namespace
}  // namespace vs::sim
