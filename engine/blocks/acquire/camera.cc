// Takes pictures from one camera.
#include <memory>
#include <utility>

#include "engine/base/mailbox.h"
#include "engine/base/mutex.h"
#include "engine/camera/camera_hub.h"
#include "engine/core/block.h"

namespace vs {
namespace {

using Box = Mailbox<FramePtr>;

class Camera final : public Block {
 public:
  Out<Frame> picture{this, "picture", "The picture with its times and numbers."};
  Out<GreyImage> image{this, "image", "Its pixels."};
  Param<std::string> address{
      this,
      "address",
      {.live = false,
       .doc = "Address of the camera: gev:SERIAL or gev-ip:ADDRESS for GigE Vision, "
              "sim:SCENE#left for the simulation, file:FOLDER?pattern=*.png for recorded "
              "pictures (FOLDER as in FileSource), camera:NAME for a camera of the server's "
              "configuration. Features may "
              "follow, as in gev:21000001?ExposureTimeAbs=5000."}};

  Camera() {
    box_.OnAvailable([this] { Wake(); });
  }

  Status Start() override {
    if (environment().cameras == nullptr) {
      return FailedPrecondition("cameras need a server: run this sequence on one");
    }
    if (address->empty()) {
      return InvalidArgument("set address to a camera's address, for example gev:21000001");
    }
    VS_ASSIGN_OR_RETURN(const CameraUri uri, CameraUri::Parse(*address));
    VS_ASSIGN_OR_RETURN(auto camera, environment().cameras->Acquire(uri));
    box_.Reopen(camera->Recorded() ? Box::Policy::kEvery : Box::Policy::kLatest);
    VS_RETURN_IF_ERROR(camera->Start([this](FramePtr taken) { box_.Put(std::move(taken)); }));
    MutexLock lock(mutex_);
    camera_ = std::move(camera);
    return {};
  }

  bool Ready() override { return box_.Available(); }

  Status Run() override {
    const auto taken = box_.TryTake();
    if (!taken) return {};
    frame().source_number = (*taken)->number;
    frame().capture_ns = (*taken)->capture_ns;
    frame().arrival_ns = (*taken)->arrival_ns;
    image.Set((*taken)->image);
    picture.Set(*taken);
    return {};
  }

  void Stop() override {
    box_.Close();
    std::shared_ptr<CameraSource> ended;
    {
      MutexLock lock(mutex_);
      ended = std::exchange(camera_, nullptr);
    }
    if (ended != nullptr) ended->Stop();
  }

  uint64_t Dropped() const override { return box_.Dropped(); }

  SourceReport Report() const override {
    MutexLock lock(mutex_);
    return camera_ == nullptr ? SourceReport() : ReportOf(camera_->Stats());
  }

 private:
  Box box_;
  mutable Mutex mutex_;  // Report comes on another thread
  std::shared_ptr<CameraSource> camera_ VS_GUARDED_BY(mutex_);
};

VS_REGISTER_BLOCK(Camera, {.category = "Acquire",
                           .doc = "Takes pictures from one camera. While the sequence is busy the "
                                  "newest picture replaces older ones."});

}  // namespace
}  // namespace vs
