#pragma once

#include <cmath>

#include "engine/image/stereo_rig.h"

namespace vs {

// A plausible real rig: 1296 x 966 px, 4 mm lenses with barrel distortion, the right camera 120 mm
// to the right and turned by about a degree.
inline StereoRig SampleRig() {
  const CameraModel left{.width = 1296,
                         .height = 966,
                         .fx_px = 1066.5,
                         .fy_px = 1067.25,
                         .cx_px = 655.5,
                         .cy_px = 478.25,
                         .k1 = -0.12,
                         .k2 = 0.08,
                         .p1 = 0.0004,
                         .p2 = -0.0003,
                         .k3 = -0.01};
  StereoRig rig{.name = "sample", .left = left, .right = left};
  rig.right.fx_px = 1064;
  rig.right.cx_px = 641;
  rig.right.k1 = -0.125;
  // About y by 0.02 rad, then about x by -0.01 rad.
  const double sy = std::sin(0.02);
  const double cy = std::cos(0.02);
  const double sx = std::sin(-0.01);
  const double cx = std::cos(-0.01);
  rig.right_from_left_rotation = {cy, 0, sy, sx * sy, cx, -sx * cy, -cx * sy, sx, cx * cy};
  rig.right_from_left_translation_m = {-0.12, 0.001, 0.002};
  return rig;
}

}  // namespace vs
