#pragma once

#include <memory>
#include <string>

#include "engine/base/mutex.h"
#include "engine/camera/camera_source.h"

namespace vs::test {

// A camera that delivers what the test tells it to. Registered as "script:NAME"; the test finds the
// one that is open by its name.
class ScriptedCamera final : public CameraSource {
 public:
  explicit ScriptedCamera(const CameraUri& uri)
      : recorded_(uri.Option("recorded") == "true"), broken_(uri.address == "broken") {}

  Status Start(FrameSink sink) override {
    if (broken_) return Unavailable("broken by the test");
    MutexLock lock(mutex_);
    ++starts_;
    sink_ = std::move(sink);
    return {};
  }
  void Stop() override {
    MutexLock lock(mutex_);
    sink_ = nullptr;
  }
  Status Trigger() override { return FailedPrecondition("no trigger"); }
  Result<std::vector<FeatureInfo>> Features() override { return std::vector<FeatureInfo>(); }
  Result<FeatureValue> GetFeature(const std::string& name) override { return NotFound(name); }
  Result<FeatureValue> SetFeature(const std::string& name, const FeatureValue&) override {
    return NotFound(name);
  }
  CameraStats Stats() const override {
    CameraStats stats;
    MutexLock lock(mutex_);
    stats.frames = delivered_;
    stats.state = sink_ ? CameraState::kStreaming : CameraState::kIdle;
    return stats;
  }
  bool Recorded() const override { return recorded_; }

  // On the calling thread; nothing happens while the camera is stopped.
  void Deliver(uint64_t number, int64_t capture_ns) {
    auto frame = std::make_shared<Frame>();
    frame->number = number;
    frame->capture_ns = capture_ns;
    FrameSink sink;
    {
      MutexLock lock(mutex_);
      if (!sink_) return;
      ++delivered_;
      sink = sink_;
    }
    sink(frame);
  }
  int starts() const {
    MutexLock lock(mutex_);
    return starts_;
  }

 private:
  const bool recorded_;
  const bool broken_;
  mutable Mutex mutex_;
  FrameSink sink_ VS_GUARDED_BY(mutex_);
  uint64_t delivered_ VS_GUARDED_BY(mutex_) = 0;
  int starts_ VS_GUARDED_BY(mutex_) = 0;
};

}  // namespace vs::test
