// Takes pairs of pictures from two cameras.
#include <algorithm>
#include <memory>
#include <utility>

#include "engine/camera/camera_hub.h"
#include "engine/camera/intake.h"
#include "engine/camera/stereo_source.h"
#include "engine/core/block.h"

namespace vs {
namespace {

class StereoCamera final : public Block {
 public:
  Out<StereoFrame> pair{this, "pair", "Two pictures of the same instant."};
  Out<double> skew_ms{this, "skew_ms",
                      "How much later the right picture was taken than the left one. Matters for "
                      "what moves."};
  Param<std::string> left{
      this,
      "left",
      {.live = false,
       .doc = "Address of the left camera: gev:SERIAL or gev-ip:ADDRESS for GigE Vision, "
              "sim:SCENE#left for the simulation, file:FOLDER for recorded pictures (FOLDER as in "
              "FileSource), camera:NAME for a camera of the server's configuration. Features may "
              "follow, as in "
              "gev:21000001?ExposureTimeAbs=5000&TriggerMode=On."}};
  Param<std::string> right{
      this,
      "right",
      {.live = false, .doc = "Address of the right camera, written like that of the left one."}};
  Param<double> tolerance_ms{
      this,
      "tolerance_ms",
      {.initial = 0,
       .min = 0.0,
       .max = 1000.0,
       .unit = "ms",
       .live = false,
       .doc = "Largest difference of the two capture times of a pair; 0 chooses a quarter of the "
              "picture period, at most 5 ms. Never more than half the picture period is used. "
              "Cameras that count triggers are paired by that count instead."}};

  Status Start() override {
    VS_ASSIGN_OR_RETURN(auto left_camera, Open(left));
    VS_ASSIGN_OR_RETURN(auto right_camera, Open(right));
    auto source = MakeCameraPair(std::move(left_camera), std::move(right_camera),
                                 {.tolerance_ns = static_cast<int64_t>(*tolerance_ms * 1e6)});
    return intake_.Start(std::move(source));
  }

  bool Ready() override { return intake_.Available(); }

  Status Run() override {
    const auto taken = intake_.TryTake();
    if (!taken) return {};
    const StereoFrame& stereo = **taken;
    frame().source_number = stereo.number;
    frame().capture_ns = stereo.left->capture_ns;
    frame().arrival_ns = std::max(stereo.left->arrival_ns, stereo.right->arrival_ns);
    skew_ms.Set(static_cast<double>(stereo.skew_ns) * 1e-6);
    pair.Set(*taken);
    return {};
  }

  void Stop() override { intake_.Stop(); }

  uint64_t Dropped() const override { return intake_.Dropped(); }

  SourceReport Report() const override { return intake_.Report(); }

 private:
  Result<std::shared_ptr<CameraSource>> Open(const Param<std::string>& address) const {
    if (environment().cameras == nullptr) {
      return FailedPrecondition("cameras need a server: run this sequence on one");
    }
    if (address->empty()) {
      return InvalidArgument("set " + address.info().name +
                             " to a camera's address, for example gev:21000001");
    }
    auto uri = CameraUri::Parse(*address);
    if (!uri) return uri.error().Annotated(address.info().name);
    auto camera = environment().cameras->Acquire(*uri);
    if (!camera) return camera.error().Annotated(address.info().name);
    return camera;
  }

  Intake<StereoSource, StereoFramePtr> intake_{[this] { Wake(); }};
};

VS_REGISTER_BLOCK(StereoCamera,
                  {.category = "Acquire",
                   .doc = "Takes pairs of pictures from two cameras that are triggered together. "
                          "While the sequence is busy the newest pair replaces older ones."});

}  // namespace
}  // namespace vs
