#pragma once

#include <array>
#include <string>

namespace vs {

// A camera by OpenCV's model: pinhole plus radial (k1, k2, k3) and tangential (p1, p2) distortion.
// Pixel centres are integers. cv: "Camera Calibration and 3D Reconstruction".
struct CameraModel {
  int width = 0;   // px, of the pictures it was calibrated with
  int height = 0;  // px
  double fx_px = 0;
  double fy_px = 0;
  double cx_px = 0;
  double cy_px = 0;
  double k1 = 0;
  double k2 = 0;
  double p1 = 0;
  double p2 = 0;
  double k3 = 0;

  bool operator==(const CameraModel&) const = default;
};

// Two cameras fixed to each other. A point in the left camera's frame (x right, y down, z forward)
// is, in the right camera's frame, rotation * point + translation_m.
struct StereoRig {
  std::string name;  // for people
  CameraModel left;
  CameraModel right;
  std::array<double, 9> right_from_left_rotation = {1, 0, 0, 0, 1, 0, 0, 0, 1};  // row-major
  std::array<double, 3> right_from_left_translation_m = {0, 0, 0};

  bool operator==(const StereoRig&) const = default;
};

}  // namespace vs
