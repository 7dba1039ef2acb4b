#include "engine/sim/demo_rig.h"

#include "engine/base/check.h"
#include "engine/sim/vec3.h"

namespace vs::sim {
namespace {

constexpr int kWidth = 1296;
constexpr int kHeight = 966;
constexpr double kFocalPx = 1067;  // 4 mm at 3.75 um per pixel
constexpr double kBaselineM = 0.12;

CameraModel Binned(CameraModel camera, int binning) {
  VS_CHECK(binning > 0 && camera.width % binning == 0 && camera.height % binning == 0);
  camera.width /= binning;
  camera.height /= binning;
  camera.fx_px /= binning;
  camera.fy_px /= binning;
  camera.cx_px = (camera.cx_px + 0.5) / binning - 0.5;
  camera.cy_px = (camera.cy_px + 0.5) / binning - 0.5;
  return camera;
}

CameraModel IdealCamera() {
  return {.width = kWidth,
          .height = kHeight,
          .fx_px = kFocalPx,
          .fy_px = kFocalPx,
          .cx_px = (kWidth - 1) / 2.0,
          .cy_px = (kHeight - 1) / 2.0};
}

// A rotation by small angles, exactly orthonormal: columns are built one upon the other, without
// trigonometric functions, which differ between machines.
Rotation SmallRotation(double about_x, double about_y, double about_z) {
  const Vec3 x = Normalized({1, about_z, -about_y});
  const Vec3 z = Normalized(Cross(x, {-about_z, 1, about_x}));
  const Vec3 y = Cross(z, x);
  return {x.x, y.x, z.x, x.y, y.y, z.y, x.z, y.z, z.z};
}

}  // namespace

StereoRig DemoRig(int binning) {
  StereoRig rig;
  rig.name = "simulated rig";
  rig.left = IdealCamera();
  rig.left.fx_px += 1.3;
  rig.left.fy_px += 0.9;
  rig.left.cx_px += 5.2;
  rig.left.cy_px -= 3.4;
  rig.left.k1 = -0.062;
  rig.left.k2 = 0.021;
  rig.left.p1 = 2.1e-4;
  rig.left.p2 = -1.7e-4;
  rig.right = IdealCamera();
  rig.right.fx_px -= 2.1;
  rig.right.fy_px -= 1.8;
  rig.right.cx_px -= 4.6;
  rig.right.cy_px += 2.7;
  rig.right.k1 = -0.058;
  rig.right.k2 = 0.018;
  rig.right.p1 = -1.2e-4;
  rig.right.p2 = 2.4e-4;
  rig.left = Binned(rig.left, binning);
  rig.right = Binned(rig.right, binning);
  // 0.25, 0.5 and 0.2 degrees.
  const Rotation right_from_left = SmallRotation(0.0044, -0.0087, 0.0035);
  const Vec3 right_in_left = {kBaselineM, 0.0007, -0.0011};
  const Vec3 translation = Rotate(right_from_left, right_in_left) * -1;
  rig.right_from_left_rotation = right_from_left;
  rig.right_from_left_translation_m = {translation.x, translation.y, translation.z};
  return rig;
}

StereoRig IdealRig(int binning) {
  StereoRig rig;
  rig.name = "ideal simulated rig";
  rig.left = Binned(IdealCamera(), binning);
  rig.right = rig.left;
  rig.right_from_left_translation_m = {-kBaselineM, 0, 0};
  return rig;
}

RectifiedGeometry IdealGeometry(int binning) {
  const StereoRig rig = IdealRig(binning);
  return {.width = rig.left.width,
          .height = rig.left.height,
          .focal_px = rig.left.fx_px,
          .baseline_m = kBaselineM,
          .cx_px = rig.left.cx_px,
          .cy_px = rig.left.cy_px};
}

}  // namespace vs::sim
