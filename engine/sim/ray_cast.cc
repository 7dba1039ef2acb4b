#include "engine/sim/ray_cast.h"

#include <cmath>

#include "engine/sim/simd.h"

namespace vs::sim {
namespace {

// A box with all that does not change from ray to ray: axes, half sizes, and the centre's position
// along each axis seen from where the rays start.
struct BoxSlabs {
  Vec3f a, b, c, half, center;

  BoxSlabs(const Box& box, Vec3 eye)
      : a(box.axes[0]),
        b(box.axes[1]),
        c(box.axes[2]),
        half(box.half_size_m),
        center(Along(box.axes, box.center_m - eye)) {}
};

struct Interval {
  float enter, leave;
};

inline float Min(float a, float b) { return a < b ? a : b; }
inline float Max(float a, float b) { return a > b ? a : b; }

// Where the ray along (x, y, z) is between the two faces of one slab.
inline Interval Slab(const Vec3f& axis, float half, float center, float x, float y, float z) {
  constexpr float kNeverZero = 1e-12f;
  const float inverse = 1.0f / (Dot(axis, x, y, z) + kNeverZero);
  const float middle = center * inverse;
  const float reach = half * std::fabs(inverse);
  return {middle - reach, middle + reach};
}

inline Interval Intersect(const BoxSlabs& box, float x, float y, float z) {
  const Interval a = Slab(box.a, box.half.x, box.center.x, x, y, z);
  const Interval b = Slab(box.b, box.half.y, box.center.y, x, y, z);
  const Interval c = Slab(box.c, box.half.z, box.center.z, x, y, z);
  return {Max(Max(a.enter, b.enter), c.enter), Min(Min(a.leave, b.leave), c.leave)};
}

VS_SIM_CLONES
void CastBoxRow(const BoxSlabs& box, uint8_t id, const float* __restrict x,
                const float* __restrict y, int count, float* __restrict depth,
                uint8_t* __restrict surface) {
  for (int i = 0; i < count; ++i) {
    const Interval hit = Intersect(box, x[i], y[i], 1.0f);
    const bool nearer = (hit.enter < hit.leave) & (hit.enter > 0.0f) & (hit.enter < depth[i]);
    depth[i] = nearer ? hit.enter : depth[i];
    surface[i] = nearer ? id : surface[i];
  }
}

VS_SIM_CLONES
void HideBehindBoxRow(const BoxSlabs& box, Vec3f eye, const float* __restrict x,
                      const float* __restrict y, const float* __restrict depth, int count,
                      uint8_t* __restrict visible) {
  // A point on the box's own near side is entered at 1, but for rounding.
  constexpr float kBefore = 1.0f - 2e-4f;
  for (int i = 0; i < count; ++i) {
    const float z = depth[i];
    const Interval hit = Intersect(box, x[i] * z - eye.x, y[i] * z - eye.y, z - eye.z);
    const bool hidden = (hit.enter < hit.leave) & (hit.enter > 0.0f) & (hit.enter < kBefore);
    visible[i] = hidden ? 0 : visible[i];
  }
}

VS_SIM_CLONES
void CastPlaneRow(Vec3f normal, float distance, uint8_t id, const float* __restrict x,
                  const float* __restrict y, int count, float* __restrict depth,
                  uint8_t* __restrict surface) {
  for (int i = 0; i < count; ++i) {
    const float hit = distance / (Dot(normal, x[i], y[i], 1.0f));
    const bool nearer = (hit > 0.0f) & (hit < depth[i]);
    depth[i] = nearer ? hit : depth[i];
    surface[i] = nearer ? id : surface[i];
  }
}

// Where the ray t * (x, y, z) enters the sphere; a negative discriminant means that it misses.
struct SphereHit {
  float discriminant, enter;
};
inline SphereHit Intersect(const Vec3f& center, float beyond_surface, float x, float y, float z) {
  const float a = x * x + y * y + z * z;
  const float b = Dot(center, x, y, z);
  const float discriminant = b * b - a * beyond_surface;
  return {discriminant, (b - std::sqrt(Max(discriminant, 0.0f))) / a};
}

VS_SIM_CLONES
void CastSphereRow(Vec3f center, float beyond_surface, uint8_t id, const float* __restrict x,
                   const float* __restrict y, int count, float* __restrict depth,
                   uint8_t* __restrict surface) {
  for (int i = 0; i < count; ++i) {
    const SphereHit hit = Intersect(center, beyond_surface, x[i], y[i], 1.0f);
    const bool nearer = (hit.discriminant > 0.0f) & (hit.enter > 0.0f) & (hit.enter < depth[i]);
    depth[i] = nearer ? hit.enter : depth[i];
    surface[i] = nearer ? id : surface[i];
  }
}

VS_SIM_CLONES
void HideBehindSphereRow(Vec3f center, float beyond_surface, Vec3f eye, const float* __restrict x,
                         const float* __restrict y, const float* __restrict depth, int count,
                         uint8_t* __restrict visible) {
  constexpr float kBefore = 1.0f - 2e-4f;
  for (int i = 0; i < count; ++i) {
    const float z = depth[i];
    const SphereHit hit =
        Intersect(center, beyond_surface, x[i] * z - eye.x, y[i] * z - eye.y, z - eye.z);
    const bool hidden = (hit.discriminant > 0.0f) & (hit.enter > 0.0f) & (hit.enter < kBefore);
    visible[i] = hidden ? 0 : visible[i];
  }
}

// How far the eye is outside of the sphere, squared as the quadratic equation wants it.
float BeyondSurface(const Sphere& sphere, Vec3 eye) {
  const Vec3 center = sphere.center_m - eye;
  return static_cast<float>(Dot(center, center) - sphere.radius_m * sphere.radius_m);
}

}  // namespace

void CastPlane(const Plane& plane, uint8_t id, const RayRow& row) {
  const Vec3& normal = plane.axes[2];
  CastPlaneRow(Vec3f(normal), static_cast<float>(Dot(normal, plane.point_m)), id, row.x, row.y,
               row.count, row.depth_m, row.surface);
}

void CastBox(const Box& box, uint8_t id, const RayRow& row) {
  CastBoxRow(BoxSlabs(box, {}), id, row.x, row.y, row.count, row.depth_m, row.surface);
}

void CastSphere(const Sphere& sphere, uint8_t id, const RayRow& row) {
  CastSphereRow(Vec3f(sphere.center_m), BeyondSurface(sphere, {}), id, row.x, row.y, row.count,
                row.depth_m, row.surface);
}

void HideBehindBox(const Box& box, Vec3 eye_m, const PointRow& row) {
  HideBehindBoxRow(BoxSlabs(box, eye_m), Vec3f(eye_m), row.x, row.y, row.depth_m, row.count,
                   row.visible);
}

void HideBehindSphere(const Sphere& sphere, Vec3 eye_m, const PointRow& row) {
  HideBehindSphereRow(Vec3f(sphere.center_m - eye_m), BeyondSurface(sphere, eye_m), Vec3f(eye_m),
                      row.x, row.y, row.depth_m, row.count, row.visible);
}

}  // namespace vs::sim
