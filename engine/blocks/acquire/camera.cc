// Takes pictures from one camera.
#include <memory>
#include <utility>

#include "engine/camera/camera_hub.h"
#include "engine/camera/intake.h"
#include "engine/core/block.h"

namespace vs {
namespace {

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

  Status Start() override {
    if (environment().cameras == nullptr) {
      return FailedPrecondition("cameras need a server: run this sequence on one");
    }
    if (address->empty()) {
      return InvalidArgument("set address to a camera's address, for example gev:21000001");
    }
    VS_ASSIGN_OR_RETURN(const CameraUri uri, CameraUri::Parse(*address));
    VS_ASSIGN_OR_RETURN(auto camera, environment().cameras->Acquire(uri));
    return intake_.Start(std::move(camera));
  }

  bool Ready() override { return intake_.Available(); }

  Status Run() override {
    const auto taken = intake_.TryTake();
    if (!taken) return {};
    frame().source_number = (*taken)->number;
    frame().capture_ns = (*taken)->capture_ns;
    frame().arrival_ns = (*taken)->arrival_ns;
    image.Set((*taken)->image);
    picture.Set(*taken);
    return {};
  }

  void Stop() override { intake_.Stop(); }

  uint64_t Dropped() const override { return intake_.Dropped(); }

  SourceReport Report() const override { return intake_.Report(); }

 private:
  Intake<CameraSource, FramePtr> intake_{[this] { Wake(); }};
};

VS_REGISTER_BLOCK(Camera, {.category = "Acquire",
                           .doc = "Takes pictures from one camera. While the sequence is busy the "
                                  "newest picture replaces older ones."});

}  // namespace
}  // namespace vs
