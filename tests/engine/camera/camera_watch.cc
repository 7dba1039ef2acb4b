#include "tests/engine/camera/camera_watch.h"

#include <gtest/gtest.h>

#include <utility>

#include "engine/base/str.h"
#include "tests/support/wait_until.h"

namespace vs::test {

CameraWatch::CameraWatch(const std::string& uri) {
  const auto parsed = CameraUri::Parse(uri);
  EXPECT_TRUE(parsed.has_value()) << parsed.error().ToString();
  auto camera = CameraDrivers::Get().Make(*parsed);
  EXPECT_TRUE(camera.has_value()) << camera.error().ToString();
  camera_ = std::move(*camera);
}

CameraWatch::~CameraWatch() { camera_->Stop(); }

bool CameraWatch::Start() {
  const Status status = camera_->Start([this](FramePtr frame) { Take(std::move(frame)); });
  EXPECT_TRUE(status.ok()) << status.ToString();
  return status.ok();
}

void CameraWatch::Take(FramePtr frame) {
  MutexLock lock(mutex_);
  if (last_ != nullptr && frame->number <= last_->number) out_of_order_ = true;
  ++frames_;
  gapless_ = last_ != nullptr && frame->number == last_->number + 1 ? gapless_ + 1 : 1;
  if (hold_) held_.push_back(frame);
  last_ = std::move(frame);
  changed_.NotifyAll();
}

uint64_t CameraWatch::Frames() const {
  MutexLock lock(mutex_);
  return frames_;
}

FramePtr CameraWatch::LastFrame() const {
  MutexLock lock(mutex_);
  return last_;
}

bool CameraWatch::OutOfOrder() const {
  MutexLock lock(mutex_);
  return out_of_order_;
}

uint64_t CameraWatch::GaplessFrames() const {
  MutexLock lock(mutex_);
  return gapless_;
}

void CameraWatch::Hold(bool hold) {
  MutexLock lock(mutex_);
  hold_ = hold;
  if (!hold) held_.clear();
}

size_t CameraWatch::Held() const {
  MutexLock lock(mutex_);
  return held_.size();
}

bool CameraWatch::WaitForFrames(uint64_t more) {
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  MutexLock lock(mutex_);
  const uint64_t wanted = frames_ + more;
  while (frames_ < wanted) {
    const auto left = deadline - std::chrono::steady_clock::now();
    if (left.count() <= 0) return false;
    changed_.WaitFor(mutex_, left);
  }
  return true;
}

bool CameraWatch::WaitForState(CameraState state) {
  return WaitFor([state](const CameraStats& stats) { return stats.state == state; });
}

bool CameraWatch::WaitFor(const std::function<bool(const CameraStats&)>& condition) {
  return WaitUntil([&] { return condition(camera_->Stats()); });
}

std::string CameraWatch::Describe() const {
  const CameraStats s = camera_->Stats();
  return Str("state ", CameraStateName(s.state), ", error \"", s.last_error, "\", frames ",
             s.frames, ", incomplete ", s.incomplete, ", stale ", s.rejected_stale, ", lost ",
             s.lost, ", underruns ", s.underruns, ", resend requests ", s.resend_requests,
             ", resent ", s.resent, ", reconnects ", s.reconnects);
}

}  // namespace vs::test
