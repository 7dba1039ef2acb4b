#pragma once

#include <array>
#include <cmath>

namespace vs::sim {

// A point or direction in metres: x right, y down, z forward.
struct Vec3 {
  double x = 0;
  double y = 0;
  double z = 0;
};

inline Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator*(Vec3 a, double s) { return {a.x * s, a.y * s, a.z * s}; }
inline double Dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3 Cross(Vec3 a, Vec3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
// std::sqrt is exact to the last bit on every machine; so must all arithmetic of the scene be.
inline Vec3 Normalized(Vec3 a) { return a * (1 / std::sqrt(Dot(a, a))); }

// The same in the precision of the inner loops.
struct Vec3f {
  float x = 0;
  float y = 0;
  float z = 0;

  explicit Vec3f(Vec3 v)
      : x(static_cast<float>(v.x)), y(static_cast<float>(v.y)), z(static_cast<float>(v.z)) {}
};
inline float Dot(const Vec3f& a, float x, float y, float z) { return a.x * x + a.y * y + a.z * z; }

// A rotation, row-major: Rotate(b_from_a, p_in_a) = p_in_b.
using Rotation = std::array<double, 9>;
inline constexpr Rotation kNoRotation = {1, 0, 0, 0, 1, 0, 0, 0, 1};

inline Vec3 Rotate(const Rotation& r, Vec3 p) {
  return {r[0] * p.x + r[1] * p.y + r[2] * p.z, r[3] * p.x + r[4] * p.y + r[5] * p.z,
          r[6] * p.x + r[7] * p.y + r[8] * p.z};
}
inline Rotation Inverse(const Rotation& r) {
  return {r[0], r[3], r[6], r[1], r[4], r[7], r[2], r[5], r[8]};
}

// Three directions at right angles to each other.
using Axes = std::array<Vec3, 3>;
inline constexpr Axes kUprightAxes = {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};

// A point's (or a direction's) components along the axes.
inline Vec3 Along(const Axes& axes, Vec3 p) {
  return {Dot(axes[0], p), Dot(axes[1], p), Dot(axes[2], p)};
}

}  // namespace vs::sim
