#pragma once

#include <cstdint>

#include "engine/sim/scene.h"

namespace vs::sim {

// Rays from the origin along (x[i], y[i], 1), and what they have hit so far.
struct RayRow {
  const float* x;
  const float* y;
  int count;
  float* depth_m;    // along z; the nearest hit
  uint8_t* surface;  // the `id` of what was hit there
};

// What is hit nowhere has this depth.
inline constexpr float kNothingM = 1e9f;

// Each replaces the hits that lie behind the given object; objects are in the rays' frame. Slabs:
// Kay and Kajiya, "Ray Tracing Complex Scenes", 1986.
void CastPlane(const Plane& plane, uint8_t id, const RayRow& row);
void CastBox(const Box& box, uint8_t id, const RayRow& row);
void CastSphere(const Sphere& sphere, uint8_t id, const RayRow& row);

// Points depth_m[i] * (x[i], y[i], 1), seen from `eye_m` (all in one frame).
struct PointRow {
  const float* x;
  const float* y;
  const float* depth_m;
  int count;
  uint8_t* visible;  // 255 or 0
};

// Each clears `visible` where the object stands between the eye and the point.
void HideBehindBox(const Box& box, Vec3 eye_m, const PointRow& row);
void HideBehindSphere(const Sphere& sphere, Vec3 eye_m, const PointRow& row);

}  // namespace vs::sim
