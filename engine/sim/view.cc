#include "engine/sim/view.h"

#include <algorithm>
#include <cmath>

namespace vs::sim {
namespace {

// Distorts a point of the plane z = 1. cv: "Camera Calibration and 3D Reconstruction".
Vec3 Distort(const CameraModel& camera, double x, double y) {
  const double r2 = x * x + y * y;
  const double radial = 1 + r2 * (camera.k1 + r2 * (camera.k2 + r2 * camera.k3));
  return {x * radial + 2 * camera.p1 * x * y + camera.p2 * (r2 + 2 * x * x),
          y * radial + camera.p1 * (r2 + 2 * y * y) + 2 * camera.p2 * x * y, 1};
}

// The inverse, by fixed-point iteration: each step gains about two digits for a lens as mild as
// ours.
Vec3 Undistort(const CameraModel& camera, double x, double y) {
  Vec3 guess = {x, y, 1};
  for (int step = 0; step < 20; ++step) {
    const Vec3 distorted = Distort(camera, guess.x, guess.y);
    const double error_x = x - distorted.x;
    const double error_y = y - distorted.y;
    guess.x += error_x;
    guess.y += error_y;
    if (std::abs(error_x) + std::abs(error_y) < 1e-9) break;
  }
  return guess;
}

void MakeRays(View& view) {
  const CameraModel& camera = view.camera;
  const size_t pixels = static_cast<size_t>(camera.width) * camera.height;
  view.ray_x.resize(pixels);
  view.ray_y.resize(pixels);
  size_t i = 0;
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x, ++i) {
      const Vec3 ray =
          Undistort(camera, (x - camera.cx_px) / camera.fx_px, (y - camera.cy_px) / camera.fy_px);
      view.ray_x[i] = static_cast<float>(ray.x);
      view.ray_y[i] = static_cast<float>(ray.y);
    }
  }
}

}  // namespace

View MakeRaylessView(const StereoRig& rig, Side side) {
  View view;
  view.camera = side == Side::kLeft ? rig.left : rig.right;
  if (side == Side::kRight) {
    const auto& t = rig.right_from_left_translation_m;
    view.view_from_rig = rig.right_from_left_rotation;
    view.origin_in_rig_m = Rotate(Inverse(view.view_from_rig), {t[0], t[1], t[2]}) * -1;
  }
  return view;
}

View MakeRawView(const StereoRig& rig, Side side) {
  View view = MakeRaylessView(rig, side);
  MakeRays(view);
  return view;
}

View MakeRectifiedView(const RectifiedView& rectified) {
  const RectifiedGeometry& geometry = rectified.geometry;
  View view;
  view.camera = {.width = geometry.width,
                 .height = geometry.height,
                 .fx_px = geometry.focal_px,
                 .fy_px = geometry.focal_px,
                 .cx_px = geometry.cx_px,
                 .cy_px = geometry.cy_px};
  view.view_from_rig = rectified.rectified_from_left;
  MakeRays(view);
  return view;
}

Vec3 ToView(const View& view, Vec3 p_in_rig) {
  return Rotate(view.view_from_rig, p_in_rig - view.origin_in_rig_m);
}

namespace {

Axes ToView(const View& view, Axes axes) {
  for (Vec3& axis : axes) axis = Rotate(view.view_from_rig, axis);
  return axes;
}

}  // namespace

Plane ToView(const View& view, Plane plane) {
  plane.point_m = ToView(view, plane.point_m);
  plane.axes = ToView(view, plane.axes);
  return plane;
}

Box ToView(const View& view, Box box) {
  box.center_m = ToView(view, box.center_m);
  box.axes = ToView(view, box.axes);
  return box;
}

Sphere ToView(const View& view, Sphere sphere) {
  sphere.center_m = ToView(view, sphere.center_m);
  sphere.axes = ToView(view, sphere.axes);
  return sphere;
}

Pixel Project(const CameraModel& camera, Vec3 p_in_view) {
  const Vec3 distorted = Distort(camera, p_in_view.x / p_in_view.z, p_in_view.y / p_in_view.z);
  return {camera.fx_px * distorted.x + camera.cx_px, camera.fy_px * distorted.y + camera.cy_px};
}

PixelRect Bounds(const CameraModel& camera, const Box& box_in_view) {
  // Straight edges bend a little between the corners when the lens distorts.
  constexpr double kRimPx = 3;
  Pixel low = {1e9, 1e9};
  Pixel high = {-1e9, -1e9};
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3& half = box_in_view.half_size_m;
    const Vec3 p = box_in_view.center_m +
                   box_in_view.axes[0] * ((corner & 1) != 0 ? half.x : -half.x) +
                   box_in_view.axes[1] * ((corner & 2) != 0 ? half.y : -half.y) +
                   box_in_view.axes[2] * ((corner & 4) != 0 ? half.z : -half.z);
    const Pixel pixel = Project(camera, p);
    low = {std::min(low.x, pixel.x), std::min(low.y, pixel.y)};
    high = {std::max(high.x, pixel.x), std::max(high.y, pixel.y)};
  }
  const auto clamped = [](double value, int size) {
    return static_cast<int>(std::clamp(value, 0.0, static_cast<double>(size)));
  };
  PixelRect rect;
  rect.x = clamped(low.x - kRimPx, camera.width);
  rect.y = clamped(low.y - kRimPx, camera.height);
  rect.width = clamped(high.x + kRimPx + 1, camera.width) - rect.x;
  rect.height = clamped(high.y + kRimPx + 1, camera.height) - rect.y;
  return rect;
}

}  // namespace vs::sim
