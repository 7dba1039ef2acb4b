#include "gpu/download.h"

#include <algorithm>

#include "engine/stereo/selection.h"

namespace vs::gpu {
namespace {

const std::byte* At(const void* memory) { return static_cast<const std::byte*>(memory); }

}  // namespace

Download DownloadOf(const Frame& frame, const DeviceMap& map) {
  const auto pixels = static_cast<size_t>(frame.Pixels());
  const std::byte* begin = At(map.disparity);
  const std::byte* end = At(map.reason) + pixels;
  const auto include = [&](const void* memory, size_t size_bytes) {
    begin = std::min(begin, At(memory));
    end = std::max(end, At(memory) + size_bytes);
  };
  if (frame.depth_m != nullptr) include(frame.depth_m, pixels * sizeof(float));
  if (frame.Rectifies()) include(frame.input[kLeft], pixels);
  return {begin, static_cast<size_t>(end - begin)};
}

StereoResult ResultIn(const Buffer& bytes, const StereoPlan& plan, const Frame& frame,
                      const DeviceMap& map, const GreyImage& left) {
  const std::byte* const begin = DownloadOf(frame, map).begin;
  const auto image = [&]<class T>(const T* on_device) {
    const size_t stride_bytes = static_cast<size_t>(frame.width) * sizeof(T);
    const size_t size_bytes = stride_bytes * static_cast<size_t>(frame.height);
    return Image<T>(
        Buffer{bytes.data + (At(on_device) - begin), size_bytes, bytes.place, bytes.owner},
        frame.width, frame.height, stride_bytes);
  };
  const RectifiedGeometry geometry = GeometryOf(plan, frame.width, frame.height);
  StereoResult result{.left = frame.Rectifies() ? image(frame.input[kLeft]) : left,
                      .disparity = {.disparity = image(map.disparity),
                                    .confidence = image(map.confidence),
                                    .reason = image(map.reason),
                                    .offset_px = DisparityOffset(frame.settings),
                                    .geometry = geometry}};
  if (frame.depth_m != nullptr) {
    result.depth = {.depth_m = image(frame.depth_m), .geometry = geometry};
  }
  return result;
}

}  // namespace vs::gpu
