#include "engine/sim/ideal_stereo.h"

#include <string>
#include <utility>

#include "engine/base/recycler.h"
#include "engine/sim/demo_rig.h"
#include "engine/sim/scene_camera.h"
#include "engine/sim/truth.h"

namespace vs::sim {

struct IdealStereo::State {
  explicit State(const IdealStereoSettings& settings)
      : geometry(IdealGeometry(settings.binning)),
        left(Camera(settings, Side::kLeft)),
        right(Camera(settings, Side::kRight)),
        truth(RectifiedView{geometry}) {
    sensor = left.DefaultSettings();
    sensor.binning_x = sensor.binning_y = settings.binning;
    sensor.width = geometry.width;
    sensor.height = geometry.height;
  }

  static SceneCamera::Settings Camera(const IdealStereoSettings& settings, Side side) {
    return {.rig = IdealRig(), .side = side, .noise = {settings.noise, settings.seed}};
  }

  FramePtr Take(SceneCamera& camera, const char* name, int64_t instant_ns, uint64_t number,
                BufferPool& pool) const {
    auto frame = std::allocate_shared<Frame>(frame_memory);
    frame->image = GreyImage(pool, sensor.width, sensor.height);
    camera.Capture(instant_ns, sensor, frame->image);
    frame->camera = name;
    frame->number = number;
    frame->trigger = number;
    frame->timestamp_ns = instant_ns;
    frame->capture_ns = instant_ns;
    frame->exposure_us = sensor.exposure_us;
    return frame;
  }

  RectifiedGeometry geometry;
  SensorSettings sensor;
  SceneCamera left;
  SceneCamera right;
  TruthRenderer truth;
  Recycler<Frame> frame_memory;
};

IdealStereo::IdealStereo(const IdealStereoSettings& settings)
    : state_(std::make_unique<State>(settings)) {}
IdealStereo::~IdealStereo() = default;
IdealStereo::IdealStereo(IdealStereo&&) noexcept = default;

StereoFrame IdealStereo::Capture(int64_t instant_ns, uint64_t number, BufferPool& pool) {
  State& s = *state_;
  StereoFrame frame;
  frame.left = s.Take(s.left, "left", instant_ns, number, pool);
  frame.right = s.Take(s.right, "right", instant_ns, number, pool);
  frame.number = number;
  frame.geometry = s.geometry;
  frame.truth = s.truth.At(instant_ns, pool).stereo;
  return frame;
}

}  // namespace vs::sim
