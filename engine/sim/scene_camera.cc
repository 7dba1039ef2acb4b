#include "engine/sim/scene_camera.h"

#include <algorithm>
#include <vector>

#include "engine/sim/hash.h"
#include "engine/sim/ray_cast.h"
#include "engine/sim/shading.h"

namespace vs::sim {
namespace {

constexpr uint8_t kTable = 0;
constexpr uint8_t kPart = 255;

SensorNoise NoiseOf(const SceneCamera::Settings& settings) {
  SensorNoise noise = settings.noise;
  noise.seed = Hash(noise.seed * 2 + (settings.side == Side::kRight ? 1 : 0));
  return noise;
}

const CameraModel& CameraOf(const SceneCamera::Settings& settings) {
  return settings.side == Side::kLeft ? settings.rig.left : settings.rig.right;
}

}  // namespace

struct SceneCamera::State {
  View view;
  Vec3 lamp;
  // What stands still: light and depth of every pixel.
  std::vector<Light> light;
  std::vector<float> depth_m;
  // The pixels that may show the part at the instant looked at, and their light.
  PixelRect patch;
  std::vector<Light> patch_light;
  // Scratch rows.
  std::vector<uint8_t> surface;
  std::vector<float> row_depth_m;
  std::vector<Light> rows;

  size_t Index(int x, int y) const { return static_cast<size_t>(y) * view.camera.width + x; }

  RayRow Rays(int x, int y, int count, float* depth) {
    const size_t i = Index(x, y);
    return {&view.ray_x[i], &view.ray_y[i], count, depth, surface.data()};
  }

  void RenderStill(const Scene& scene) {
    const Plane table = ToView(view, scene.table);
    std::vector<Box> boxes;
    for (const Box& box : scene.boxes) boxes.push_back(ToView(view, box));
    std::vector<Sphere> spheres;
    for (const Sphere& sphere : scene.spheres) spheres.push_back(ToView(view, sphere));
    for (int y = 0; y < view.camera.height; ++y) {
      const RayRow row = Rays(0, y, view.camera.width, &depth_m[Index(0, y)]);
      Light* row_light = &light[Index(0, y)];
      CastPlane(table, kTable, row);
      uint8_t id = kTable;
      for (const Box& box : boxes) CastBox(box, ++id, row);
      for (const Sphere& sphere : spheres) CastSphere(sphere, ++id, row);
      ShadePlane(table, lamp, kTable, row, row_light);
      id = kTable;
      for (const Box& box : boxes) ShadeBox(box, lamp, ++id, row, row_light);
      for (const Sphere& sphere : spheres) ShadeSphere(sphere, lamp, ++id, row, row_light);
    }
  }

  void RenderPart(const Box& part) {
    patch = Bounds(view.camera, part);
    patch_light.resize(static_cast<size_t>(patch.width) * patch.height);
    for (int y = 0; y < patch.height; ++y) {
      const size_t still = Index(patch.x, patch.y + y);
      Light* row_light = &patch_light[static_cast<size_t>(y) * patch.width];
      std::copy_n(&depth_m[still], patch.width, row_depth_m.begin());
      std::copy_n(&light[still], patch.width, row_light);
      std::fill_n(surface.begin(), patch.width, kTable);
      const RayRow row = Rays(patch.x, patch.y + y, patch.width, row_depth_m.data());
      CastBox(part, kPart, row);
      ShadeBox(part, lamp, kPart, row, row_light);
    }
  }
};

SceneCamera::SceneCamera(const Settings& settings)
    : PictureSource(CameraOf(settings).width, CameraOf(settings).height, settings.sensitivity,
                    NoiseOf(settings)),
      state_(std::make_unique<State>()) {
  State& s = *state_;
  s.view = MakeRawView(settings.rig, settings.side);
  s.lamp = Rotate(s.view.view_from_rig, LampInRig());
  const size_t pixels = static_cast<size_t>(width()) * height();
  s.light.resize(pixels, 0);
  s.depth_m.resize(pixels, kNothingM);
  s.surface.resize(width(), kTable);
  s.row_depth_m.resize(width());
  s.rows.resize(static_cast<size_t>(width()) * kMaxBinning);
  s.RenderStill(DemoScene());
}

SceneCamera::~SceneCamera() = default;

void SceneCamera::Look(int64_t instant_ns) {
  state_->RenderPart(ToView(state_->view, DemoPart(instant_ns)));
}

const Light* SceneCamera::LightRows(int y, int count) {
  State& s = *state_;
  const Light* still = &s.light[s.Index(0, y)];
  if (y + count <= s.patch.y || y >= s.patch.y + s.patch.height) return still;
  std::copy_n(still, static_cast<size_t>(count) * width(), s.rows.begin());
  for (int i = 0; i < count; ++i) {
    const int patch_y = y + i - s.patch.y;
    if (patch_y < 0 || patch_y >= s.patch.height) continue;
    std::copy_n(&s.patch_light[static_cast<size_t>(patch_y) * s.patch.width], s.patch.width,
                s.rows.begin() + static_cast<size_t>(i) * width() + s.patch.x);
  }
  return s.rows.data();
}

}  // namespace vs::sim
