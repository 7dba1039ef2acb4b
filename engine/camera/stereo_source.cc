#include "engine/camera/stereo_source.h"

#include <optional>
#include <utility>

#include "engine/base/mutex.h"
#include "engine/base/recycler.h"

namespace vs {
namespace {

class CameraPair final : public StereoSource {
 public:
  CameraPair(std::shared_ptr<CameraSource> left, std::shared_ptr<CameraSource> right,
             PairerOptions options)
      : left_(std::move(left)),
        right_(std::move(right)),
        recorded_(left_->Recorded() && right_->Recorded()),
        pairer_(options) {}
  ~CameraPair() override { Stop(); }

  Status Start(StereoSink sink) override {
    {
      MutexLock order(order_mutex_);
      sink_ = std::move(sink);
    }
    {
      MutexLock lock(mutex_);
      stopping_ = false;
    }
    if (Status status = StartSide(*left_, Side::kLeft); !status.ok()) {
      return status.Annotated("left camera");
    }
    if (Status status = StartSide(*right_, Side::kRight); !status.ok()) {
      Stop();
      return status.Annotated("right camera");
    }
    return {};
  }

  void Stop() override {
    {
      MutexLock lock(mutex_);
      stopping_ = true;
      room_.NotifyAll();
    }
    left_->Stop();
    right_->Stop();
  }

  StereoStats Stats() const override {
    StereoStats stats;
    stats.left = left_->Stats();
    stats.right = right_->Stats();
    MutexLock lock(mutex_);
    stats.pairing = pairer_.Stats();
    return stats;
  }

  bool Recorded() const override { return recorded_; }

 private:
  Status StartSide(CameraSource& camera, Side side) {
    return camera.Start([this, side](FramePtr frame) { Take(side, std::move(frame)); });
  }

  void Take(Side side, FramePtr frame) {
    if (recorded_ && !WaitForRoom(side)) return;
    MutexLock order(order_mutex_);
    std::optional<StereoFrame> pair;
    {
      MutexLock lock(mutex_);
      pair = pairer_.Add(side, std::move(frame));
      room_.NotifyAll();
    }
    if (pair) sink_(std::allocate_shared<StereoFrame>(memory_, std::move(*pair)));
  }

  // Of two recorded cameras, the faster one waits, so that none of its pictures is dropped.
  bool WaitForRoom(Side side) {
    MutexLock lock(mutex_);
    while (!stopping_ && pairer_.Waiting(side) == Pairer::kDepth) room_.Wait(mutex_);
    return !stopping_;
  }

  const std::shared_ptr<CameraSource> left_;
  const std::shared_ptr<CameraSource> right_;
  const bool recorded_;
  Recycler<StereoFrame> memory_;

  Mutex order_mutex_;  // held while a pair is handed on, so that pairs leave in order
  StereoSink sink_ VS_GUARDED_BY(order_mutex_);

  mutable Mutex mutex_;  // may be taken with order_mutex_ held
  CondVar room_;
  Pairer pairer_ VS_GUARDED_BY(mutex_);
  bool stopping_ VS_GUARDED_BY(mutex_) = false;
};

}  // namespace

std::unique_ptr<StereoSource> MakeCameraPair(std::shared_ptr<CameraSource> left,
                                             std::shared_ptr<CameraSource> right,
                                             PairerOptions options) {
  return std::make_unique<CameraPair>(std::move(left), std::move(right), options);
}

}  // namespace vs
