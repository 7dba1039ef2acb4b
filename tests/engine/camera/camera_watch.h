#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/mutex.h"
#include "engine/camera/camera_source.h"
#include "tests/support/child_process.h"

namespace vs::test {

// Opens a camera by its URI and keeps an eye on what it delivers.
class CameraWatch {
 public:
  explicit CameraWatch(const std::string& uri);
  ~CameraWatch();

  bool Start();
  CameraSource& camera() { return *camera_; }

  uint64_t Frames() const;
  FramePtr LastFrame() const;
  // Frame numbers ran back or repeated.
  bool OutOfOrder() const;
  // Frames since the last gap in their numbers.
  uint64_t GaplessFrames() const;
  // The next frames are kept, which keeps their buffers.
  void Hold(bool hold);
  size_t Held() const;

  // Each gives up after kPatience.
  bool WaitForFrames(uint64_t more);
  bool WaitForState(CameraState state);
  bool WaitFor(const std::function<bool(const CameraStats&)>& condition);

  // For the message of a failed assertion.
  std::string Describe() const;

 private:
  void Take(FramePtr frame);

  std::unique_ptr<CameraSource> camera_;
  mutable Mutex mutex_;
  CondVar changed_;
  uint64_t frames_ VS_GUARDED_BY(mutex_) = 0;
  FramePtr last_ VS_GUARDED_BY(mutex_);
  uint64_t gapless_ VS_GUARDED_BY(mutex_) = 0;
  bool out_of_order_ VS_GUARDED_BY(mutex_) = false;
  bool hold_ VS_GUARDED_BY(mutex_) = false;
  std::vector<FramePtr> held_ VS_GUARDED_BY(mutex_);
};

}  // namespace vs::test
