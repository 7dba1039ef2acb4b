#include "engine/sim/truth.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "engine/base/recycler.h"
#include "engine/sim/ray_cast.h"
#include "engine/sim/view.h"

namespace vs::sim {
namespace {

constexpr uint8_t kStill = 0;
constexpr uint8_t kPart = 1;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// True where a raw camera's picture shows the point.
bool Sees(const View& raw, Vec3 p_in_rig) {
  const Vec3 p = ToView(raw, p_in_rig);
  if (p.z <= 0) return false;
  const Pixel pixel = Project(raw.camera, p);
  return pixel.x >= 0 && pixel.x <= raw.camera.width - 1 && pixel.y >= 0 &&
         pixel.y <= raw.camera.height - 1;
}

}  // namespace

struct TruthRenderer::State {
  RectifiedGeometry geometry;
  View view;
  Vec3 right_eye_m;             // this and the objects in the view's frame
  std::vector<View> raw_views;  // that must show a point
  std::vector<Box> boxes;
  std::vector<Sphere> spheres;
  // What stands still, for each pixel.
  std::vector<float> depth_m;
  std::vector<uint8_t> visible;
  std::vector<uint8_t> surface;  // scratch row
  Recycler<StereoTruth> truth_memory;

  size_t Index(int x, int y) const { return static_cast<size_t>(y) * geometry.width + x; }

  float Disparity(float depth) const {
    return static_cast<float>(geometry.focal_px * geometry.baseline_m / depth -
                              geometry.principal_offset_px);
  }

  void RenderStill(const Scene& scene) {
    const Plane table = ToView(view, scene.table);
    for (const Box& box : scene.boxes) boxes.push_back(ToView(view, box));
    for (const Sphere& sphere : scene.spheres) spheres.push_back(ToView(view, sphere));
    for (int y = 0; y < geometry.height; ++y) {
      float* depth = &depth_m[Index(0, y)];
      const RayRow row = {&view.ray_x[Index(0, y)], &view.ray_y[Index(0, y)], geometry.width, depth,
                          surface.data()};
      CastPlane(table, kStill, row);
      for (const Box& box : boxes) CastBox(box, kStill, row);
      for (const Sphere& sphere : spheres) CastSphere(sphere, kStill, row);
      MarkVisible(0, y, geometry.width, depth, &visible[Index(0, y)]);
    }
  }

  // Where the point of a row's pixels is seen by both cameras, were it not for the part.
  void MarkVisible(int x, int y, int count, const float* depth, uint8_t* mark) const {
    const size_t begin = Index(x, y);
    for (int i = 0; i < count; ++i) {
      mark[i] = ShownByBoth(x + i, begin + i, depth[i]) ? 255 : 0;
    }
    const PointRow points = {&view.ray_x[begin], &view.ray_y[begin], depth, count, mark};
    for (const Box& box : boxes) HideBehindBox(box, right_eye_m, points);
    for (const Sphere& sphere : spheres) HideBehindSphere(sphere, right_eye_m, points);
  }

  // Inside of both pictures.
  bool ShownByBoth(int x, size_t index, float depth) const {
    if (depth >= kNothingM) return false;
    const float right_x = static_cast<float>(x) - Disparity(depth);
    if (right_x < 0 || right_x > static_cast<float>(geometry.width - 1)) return false;
    const Vec3 p = {double{view.ray_x[index]} * depth, double{view.ray_y[index]} * depth, depth};
    const Vec3 p_in_rig = Rotate(Inverse(view.view_from_rig), p);
    return std::all_of(raw_views.begin(), raw_views.end(),
                       [p_in_rig](const View& raw) { return Sees(raw, p_in_rig); });
  }

  // Puts the part into one row of the picture.
  void AddPart(const Box& part, const PixelRect& where, int y, float* depth, uint8_t* mark) {
    std::fill_n(surface.begin(), where.width, kStill);
    const size_t begin = Index(where.x, y);
    CastBox(part, kPart,
            {&view.ray_x[begin], &view.ray_y[begin], where.width, depth, surface.data()});
    for (int i = 0; i < where.width;) {
      int end = i;
      while (end < where.width && surface[end] == kPart) ++end;
      MarkVisible(where.x + i, y, end - i, depth + i, mark + i);
      i = end + 1;
    }
  }

  // The pixels whose point the part may hide from the right camera: the part's place in the right
  // view, moved by any disparity that something behind it can have.
  PixelRect Shadow(const Box& part) const {
    Box in_right = part;
    in_right.center_m = part.center_m - right_eye_m;
    CameraModel right = view.camera;
    right.cx_px += geometry.principal_offset_px;
    PixelRect rect = Bounds(right, in_right);
    const double reach_m = in_right.half_size_m.x + in_right.half_size_m.y + in_right.half_size_m.z;
    const float nearest = Disparity(static_cast<float>(part.center_m.z - reach_m));
    const float farthest = std::min(0.0f, static_cast<float>(-geometry.principal_offset_px));
    const int begin = std::clamp(rect.x + static_cast<int>(farthest) - 1, 0, geometry.width);
    const int end =
        std::clamp(rect.x + rect.width + static_cast<int>(nearest) + 1, begin, geometry.width);
    rect.x = begin;
    rect.width = end - begin;
    return rect;
  }
};

TruthRenderer::TruthRenderer(const RectifiedView& view, const std::optional<StereoRig>& raw_rig)
    : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.geometry = view.geometry;
  s.view = MakeRectifiedView(view);
  s.right_eye_m = {view.geometry.baseline_m, 0, 0};
  if (raw_rig) {
    s.raw_views = {MakeRaylessView(*raw_rig, Side::kLeft), MakeRaylessView(*raw_rig, Side::kRight)};
  }
  const size_t pixels = static_cast<size_t>(view.geometry.width) * view.geometry.height;
  s.depth_m.resize(pixels, kNothingM);
  s.visible.resize(pixels);
  s.surface.resize(view.geometry.width);
  s.RenderStill(DemoScene());
}

TruthRenderer::~TruthRenderer() = default;
TruthRenderer::TruthRenderer(TruthRenderer&&) noexcept = default;

SceneTruth TruthRenderer::At(int64_t instant_ns, BufferPool& pool) {
  State& s = *state_;
  const int width = s.geometry.width;
  const int height = s.geometry.height;
  Image<float> depth(pool, width, height);
  std::copy(s.depth_m.begin(), s.depth_m.end(), depth.Row(0));
  GreyImage visible(pool, width, height);
  std::copy(s.visible.begin(), s.visible.end(), visible.Row(0));

  const Box part = ToView(s.view, DemoPart(instant_ns));
  const PixelRect place = Bounds(s.view.camera, part);
  for (int y = place.y; y < place.y + place.height; ++y) {
    s.AddPart(part, place, y, depth.Row(y) + place.x, visible.Row(y) + place.x);
  }
  const PixelRect shadow = s.Shadow(part);
  for (int y = shadow.y; y < shadow.y + shadow.height; ++y) {
    const size_t begin = s.Index(shadow.x, y);
    HideBehindBox(part, s.right_eye_m,
                  {&s.view.ray_x[begin], &s.view.ray_y[begin], depth.Row(y) + shadow.x,
                   shadow.width, visible.Row(y) + shadow.x});
  }

  Image<float> disparity(pool, width, height);
  for (int y = 0; y < height; ++y) {
    float* row = depth.Row(y);
    for (int x = 0; x < width; ++x) {
      if (row[x] >= kNothingM) row[x] = kNan;
      disparity.Row(y)[x] = s.Disparity(row[x]);
    }
  }
  SceneTruth truth;
  truth.stereo = std::allocate_shared<StereoTruth>(
      s.truth_memory, StereoTruth{std::move(disparity), std::move(visible)});
  truth.depth_m = std::move(depth);
  return truth;
}

}  // namespace vs::sim
