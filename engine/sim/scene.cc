#include "engine/sim/scene.h"

namespace vs::sim {
namespace {

// Seen from the cameras the table is 0.88 m away at the picture's centre and leans away at the top.
constexpr Vec3 kTableCenter = {0, 0, 0.88};

// The table's axes: to the right, towards the viewer (down in the picture), up.
Axes TableAxes() {
  const Vec3 up = Normalized({0.05, -0.48, -0.86});
  const Vec3 right = Normalized(Cross({0, 0, 1}, up));
  return {right, Cross(right, up), up};
}

// `height_m` above the point (right_m, near_m) of the table.
Vec3 OnTable(double right_m, double near_m, double height_m) {
  const Axes axes = TableAxes();
  return kTableCenter + axes[0] * right_m + axes[1] * near_m + axes[2] * height_m;
}

// Sine and cosine of an angle in turns. The C library's own differ in the last bit from one CPU to
// another, and then so would the pictures.
double SineOfTurns(double turns) {
  constexpr double kRadiansPerTurn = 6.283185307179586;
  turns -= static_cast<double>(static_cast<int64_t>(turns));
  if (turns < 0) turns += 1;
  double sign = 1;
  if (turns >= 0.5) {
    turns -= 0.5;
    sign = -1;
  }
  if (turns > 0.25) turns = 0.5 - turns;
  const double x = turns * kRadiansPerTurn;
  const double x2 = x * x;
  // Taylor's series up to x^15: exact to 1e-12 within a quarter turn.
  double sum = 1;
  for (int n = 15; n >= 3; n -= 2) sum = 1 - x2 / (n * (n - 1)) * sum;
  return sign * x * sum;
}
double CosineOfTurns(double turns) { return SineOfTurns(turns + 0.25); }

// A box that stands on the table, turned about the upright.
Box StandingBox(double right_m, double near_m, double yaw_turns, Vec3 half_size_m,
                const Surface& surface) {
  const double c = CosineOfTurns(yaw_turns);
  const double s = SineOfTurns(yaw_turns);
  const Axes table = TableAxes();
  return {.center_m = OnTable(right_m, near_m, half_size_m.z),
          .axes = {table[0] * c + table[1] * s, table[1] * c - table[0] * s, table[2]},
          .half_size_m = half_size_m,
          .surface = surface};
}

Sphere LyingSphere(double right_m, double near_m, double radius_m, const Surface& surface) {
  return {.center_m = OnTable(right_m, near_m, radius_m),
          .axes = kUprightAxes,
          .radius_m = radius_m,
          .surface = surface};
}

}  // namespace

Scene DemoScene() {
  Scene scene;
  scene.table = {.point_m = kTableCenter,
                 .axes = TableAxes(),
                 .surface = {.mean_grey = 112, .contrast_grey = 85, .pattern_m = 0.3}};
  scene.boxes = {
      StandingBox(-0.22, 0.08, 0.06, {0.075, 0.055, 0.05}, {135, 90, 1.7}),
      StandingBox(0.27, 0.12, -0.05, {0.055, 0.055, 0.07}, {125, 95, 2.9}),
      StandingBox(0.30, -0.20, 0.13, {0.05, 0.085, 0.045}, {145, 85, 4.3}),
  };
  scene.spheres = {
      LyingSphere(-0.25, -0.19, 0.065, {140, 95, 5.1}),
      LyingSphere(0.05, 0.20, 0.045, {150, 90, 6.7}),
  };
  return scene;
}

Box DemoPart(int64_t instant_ns) {
  constexpr int64_t kPeriodNs = 24'000'000'000;
  const int64_t phase_ns = (instant_ns % kPeriodNs + kPeriodNs) % kPeriodNs;
  const double phase_turns = static_cast<double>(phase_ns) / static_cast<double>(kPeriodNs);
  // To and fro in 8 s, and one turn about the upright in 24 s.
  const double right_m = 0.03 + 0.12 * SineOfTurns(3 * phase_turns);
  return StandingBox(right_m, -0.06, phase_turns, {0.06, 0.04, 0.035}, {150, 85, 8.1});
}

}  // namespace vs::sim
