#include "engine/camera/shared_camera.h"

#include <utility>

namespace vs {

class SharedCamera::Handle final : public CameraSource {
 public:
  explicit Handle(std::shared_ptr<SharedCamera> shared) : shared_(std::move(shared)) {}
  ~Handle() override { shared_->Stop(this); }

  Status Start(FrameSink sink) override { return shared_->Start(this, std::move(sink)); }
  void Stop() override { shared_->Stop(this); }
  Status Trigger() override { return camera().Trigger(); }
  Result<std::vector<FeatureInfo>> Features() override { return camera().Features(); }
  Result<FeatureValue> GetFeature(const std::string& name) override {
    return camera().GetFeature(name);
  }
  Result<FeatureValue> SetFeature(const std::string& name, const FeatureValue& value) override {
    return camera().SetFeature(name, value);
  }
  CameraStats Stats() const override { return camera().Stats(); }
  bool Recorded() const override { return camera().Recorded(); }

 private:
  CameraSource& camera() const { return *shared_->camera_; }

  const std::shared_ptr<SharedCamera> shared_;
};

std::unique_ptr<CameraSource> SharedCamera::MakeHandle() {
  return std::make_unique<Handle>(shared_from_this());
}

Status SharedCamera::Start(const Handle* handle, FrameSink sink) {
  MutexLock start(start_mutex_);
  bool first = false;
  {
    MutexLock lock(sinks_mutex_);
    first = sinks_.empty();
    sinks_[handle] = std::move(sink);
  }
  if (!first) return {};
  Status status = camera_->Start([this](const FramePtr& frame) { Spread(frame); });
  if (!status.ok()) {
    MutexLock lock(sinks_mutex_);
    sinks_.erase(handle);
  }
  return status;
}

void SharedCamera::Stop(const Handle* handle) {
  MutexLock start(start_mutex_);
  bool last = false;
  {
    MutexLock lock(sinks_mutex_);
    if (sinks_.erase(handle) == 0) return;
    last = sinks_.empty();
  }
  if (last) camera_->Stop();
}

void SharedCamera::Spread(const FramePtr& frame) {
  MutexLock lock(sinks_mutex_);
  for (const auto& [handle, sink] : sinks_) sink(frame);
}

}  // namespace vs
