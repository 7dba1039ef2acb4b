#pragma once

#include <vector>

#include "engine/image/pixel_rect.h"
#include "engine/image/stereo_rig.h"
#include "engine/sim/scene.h"
#include "engine/sim/truth.h"
#include "engine/sim/vec3.h"

namespace vs::sim {

enum class Side { kLeft, kRight };

// A camera as a ray caster sees it. Pixel (x, y) looks from the origin of the view's own frame
// along (ray_x, ray_y, 1), both found at index y * width + x; lens distortion is all in there. So a
// hit at z metres along the optical axis is at z * (ray_x, ray_y, 1).
struct View {
  CameraModel camera;
  Rotation view_from_rig = kNoRotation;
  Vec3 origin_in_rig_m;
  std::vector<float> ray_x;
  std::vector<float> ray_y;
};

// A raw camera of the rig. The rig's frame is that of its left camera.
View MakeRawView(const StereoRig& rig, Side side);
// The same without its rays: enough to project points.
View MakeRaylessView(const StereoRig& rig, Side side);
// The left view after rectification.
View MakeRectifiedView(const RectifiedView& rectified);

Vec3 ToView(const View& view, Vec3 p_in_rig);
Plane ToView(const View& view, Plane plane);
Box ToView(const View& view, Box box);
Sphere ToView(const View& view, Sphere sphere);

struct Pixel {
  double x = 0;
  double y = 0;
};
// Where a point of the view's frame appears (z > 0), with the lens distortion.
Pixel Project(const CameraModel& camera, Vec3 p_in_view);

// All pixels that can show a box given in the view's frame, and a rim of a few pixels more.
PixelRect Bounds(const CameraModel& camera, const Box& box_in_view);

}  // namespace vs::sim
