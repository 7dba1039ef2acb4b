// The drivers "gev" and "gev-ip": GigE Vision cameras by serial number and by address.
#include <chrono>
#include <memory>
#include <utility>

#include "engine/base/str.h"
#include "engine/camera/camera_source.h"
#include "engine/camera/gev_device.h"

namespace vs {
namespace {

using std::chrono::steady_clock;

// So long may one step read features before the next picture is looked after.
constexpr std::chrono::milliseconds kReadingSlice{4};

class GevCamera final : public CameraSource {
 public:
  explicit GevCamera(GevCameraOptions options)
      : uri_(options.uri), device_(std::make_unique<GevDevice>(std::move(options))) {}

  Status Start(FrameSink sink) override { return device_->Start(std::move(sink)); }
  void Stop() override { device_->Stop(); }
  CameraStats Stats() const override { return device_->Stats(); }

  Status Trigger() override {
    const auto done = OnDevice<bool>([](GevDevice& device) -> std::optional<Result<bool>> {
      const Status status = device.SoftwareTrigger();
      return status.ok() ? Result<bool>(true) : status;
    });
    return done ? Status() : done.error();
  }

  Result<std::vector<FeatureInfo>> Features() override {
    struct Reading {
      std::vector<std::string> names;
      std::vector<FeatureInfo> infos;
      size_t next = 0;
    };
    using Infos = std::vector<FeatureInfo>;
    auto reading = std::make_shared<Reading>();
    return OnDevice<Infos>([reading](GevDevice& device) -> std::optional<Result<Infos>> {
      if (reading->names.empty()) reading->names = device.features().Names();
      const auto deadline = steady_clock::now() + kReadingSlice;
      while (reading->next < reading->names.size()) {
        if (steady_clock::now() >= deadline) return std::nullopt;
        auto info = device.features().Info(reading->names[reading->next++]);
        if (info) reading->infos.push_back(std::move(*info));
      }
      return Result<Infos>(std::move(reading->infos));
    });
  }

  Result<FeatureValue> GetFeature(const std::string& name) override {
    return OnDevice<FeatureValue>([name](GevDevice& device) -> std::optional<Result<FeatureValue>> {
      return device.features().Get(name);
    });
  }

  Result<FeatureValue> SetFeature(const std::string& name, const FeatureValue& value) override {
    return OnDevice<FeatureValue>(
        [name, value](GevDevice& device) -> std::optional<Result<FeatureValue>> {
          return device.SetFeature(name, value);
        });
  }

 private:
  template <class T>
  Result<T> OnDevice(GevDevice::Calls::Step<T> step) {
    auto result = device_->calls().Call<T>(std::move(step));
    if (!result) return result.error().Annotated("camera " + uri_);
    return result;
  }

  const std::string uri_;
  const std::unique_ptr<GevDevice> device_;
};

Result<std::unique_ptr<CameraSource>> MakeGevCamera(const CameraUri& uri) {
  GevCameraOptions camera;
  UriOptions options(uri);
  camera.stream.buffers = static_cast<int>(options.Integer("buffers", 8, 3, 64));
  camera.stream.resend = options.Flag("resend", true);
  camera.packet_bytes = static_cast<int>(options.Integer("packet_bytes", 0, 0, 16384));
  VS_RETURN_IF_ERROR(options.Check());
  if (camera.packet_bytes != 0 && (camera.packet_bytes < 576 || camera.packet_bytes % 4 != 0)) {
    return InvalidArgument(Str("camera ", uri.ToString(),
                               ": packet_bytes must be 0 (automatic) or a multiple of 4 from 576"));
  }
  (uri.scheme == "gev" ? camera.serial : camera.address) = uri.address;
  camera.features = uri.Features();
  camera.uri = uri.scheme + ":" + uri.address;
  return std::unique_ptr<CameraSource>(std::make_unique<GevCamera>(std::move(camera)));
}

VS_REGISTER_CAMERA("gev", MakeGevCamera);
VS_REGISTER_CAMERA("gev-ip", MakeGevCamera);

}  // namespace
}  // namespace vs
