#pragma once

#include <map>
#include <memory>

#include "engine/base/mutex.h"
#include "engine/camera/camera_source.h"

namespace vs {

// One camera with several users. Each user holds a handle that is a CameraSource of its own; the
// camera streams while at least one handle does, and every streaming handle gets every picture.
class SharedCamera : public std::enable_shared_from_this<SharedCamera> {
 public:
  explicit SharedCamera(std::unique_ptr<CameraSource> camera) : camera_(std::move(camera)) {}

  std::unique_ptr<CameraSource> MakeHandle();
  CameraSource& camera() { return *camera_; }

 private:
  class Handle;

  Status Start(const Handle* handle, FrameSink sink);
  void Stop(const Handle* handle);
  void Spread(const FramePtr& frame);

  const std::unique_ptr<CameraSource> camera_;
  Mutex start_mutex_;  // one Start or Stop of the camera at a time
  Mutex sinks_mutex_;  // may be taken with start_mutex_ held
  std::map<const Handle*, FrameSink> sinks_ VS_GUARDED_BY(sinks_mutex_);
};

}  // namespace vs
