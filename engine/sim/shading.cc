#include "engine/sim/shading.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/sim/texture.h"

namespace vs::sim {
namespace {

constexpr float kAmbient = 0.45f;
constexpr float kFromLamp = 0.55f;

// A surface as it looks under a certain amount of light.
class Paint {
 public:
  Paint(const Surface& surface, float illumination, double pattern_offset_m = 0)
      : mean_(static_cast<float>(surface.mean_grey * kLightPerGrey) * illumination),
        contrast_(static_cast<float>(surface.contrast_grey * kLightPerGrey) * illumination),
        pattern_(static_cast<float>(surface.pattern_m + pattern_offset_m)) {}

  float Pattern(float u, float v) const { return texture_.At(u + pattern_, v + pattern_); }
  Light At(float u, float v) const { return Of(Pattern(u, v)); }
  Light Of(float pattern) const {
    return static_cast<Light>(std::clamp(mean_ + contrast_ * pattern, 0.0f, 65535.0f));
  }

 private:
  float mean_, contrast_, pattern_;
  Texture texture_;
};

float Illumination(double cosine_to_lamp) {
  return kAmbient + kFromLamp * std::max(0.0f, static_cast<float>(cosine_to_lamp));
}

// Turns a ray and its depth into coordinates along an object's axes, from its centre.
struct LocalFrame {
  Vec3f a, b, c, center;

  LocalFrame(const Axes& axes, Vec3 center_m)
      : a(axes[0]), b(axes[1]), c(axes[2]), center(Along(axes, center_m)) {}

  struct Point {
    float a, b, c;
  };
  Point At(float x, float y, float depth) const {
    return {depth * Dot(a, x, y, 1) - center.x, depth * Dot(b, x, y, 1) - center.y,
            depth * Dot(c, x, y, 1) - center.z};
  }
};

}  // namespace

Vec3 LampInRig() { return Normalized({-0.35, -0.75, -0.56}); }

void ShadePlane(const Plane& plane, Vec3 lamp, uint8_t id, const RayRow& row, Light* light) {
  const Paint paint(plane.surface, Illumination(Dot(plane.axes[2], lamp)));
  const LocalFrame frame(plane.axes, plane.point_m);
  for (int i = 0; i < row.count; ++i) {
    if (row.surface[i] != id) continue;
    const auto p = frame.At(row.x[i], row.y[i], row.depth_m[i]);
    light[i] = paint.At(p.a, p.b);
  }
}

void ShadeBox(const Box& box, Vec3 lamp, uint8_t id, const RayRow& row, Light* light) {
  const Vec3 cosine = Along(box.axes, lamp);
  // Each face shows another piece of the pattern: [axis][0 = low, 1 = high side].
  const auto pair = [&box](double axis_cosine, double offset_m) {
    return std::array{Paint(box.surface, Illumination(-axis_cosine), offset_m),
                      Paint(box.surface, Illumination(axis_cosine), offset_m + 0.61)};
  };
  const auto a_faces = pair(cosine.x, 0);
  const auto b_faces = pair(cosine.y, 0.17);
  const auto c_faces = pair(cosine.z, 0.34);
  const Vec3f half(box.half_size_m);
  const LocalFrame frame(box.axes, box.center_m);
  for (int i = 0; i < row.count; ++i) {
    if (row.surface[i] != id) continue;
    const auto p = frame.At(row.x[i], row.y[i], row.depth_m[i]);
    const float off_a = std::fabs(std::fabs(p.a) - half.x);
    const float off_b = std::fabs(std::fabs(p.b) - half.y);
    const float off_c = std::fabs(std::fabs(p.c) - half.z);
    if (off_c <= off_a && off_c <= off_b) {
      light[i] = c_faces[p.c > 0 ? 1 : 0].At(p.a, p.b);
    } else if (off_a <= off_b) {
      light[i] = a_faces[p.a > 0 ? 1 : 0].At(p.b, p.c);
    } else {
      light[i] = b_faces[p.b > 0 ? 1 : 0].At(p.a, p.c);
    }
  }
}

void ShadeSphere(const Sphere& sphere, Vec3 lamp, uint8_t id, const RayRow& row, Light* light) {
  const LocalFrame frame(sphere.axes, sphere.center_m);
  const Vec3f to_lamp(Along(sphere.axes, lamp));
  const auto per_radius = static_cast<float>(1 / sphere.radius_m);
  for (int i = 0; i < row.count; ++i) {
    if (row.surface[i] != id) continue;
    const auto p = frame.At(row.x[i], row.y[i], row.depth_m[i]);
    const float a = p.a * per_radius;
    const float b = p.b * per_radius;
    const float c = p.c * per_radius;
    const Paint paint(sphere.surface, Illumination(Dot(to_lamp, a, b, c)));
    // Seen along each axis, weighted by how squarely the surface faces it: no poles, no seams.
    light[i] = paint.Of(a * a * paint.Pattern(p.b, p.c) + b * b * paint.Pattern(p.a, p.c) +
                        c * c * paint.Pattern(p.a, p.b));
  }
}

}  // namespace vs::sim
