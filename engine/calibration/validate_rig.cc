#include "engine/calibration/validate_rig.h"

#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/str.h"

namespace vs {
namespace {

constexpr double kLeastBaselineM = 1e-4;
constexpr double kLargestBaselineM = 100;
constexpr double kRotationTolerance = 1e-6;

void CheckCamera(const CameraModel& camera, const std::string& name, std::vector<Fault>* faults) {
  const auto wrong = [&](const char* field, std::string message) {
    faults->push_back({name + "." + field, std::move(message)});
  };
  const auto is_size = [](int value) { return value >= 16 && value <= 16384; };
  const auto check_size = [&](const char* field, int value) {
    if (!is_size(value)) {
      wrong(field, Str("is ", value, " px; it must be 16 .. 16384 px"));
    }
  };
  const auto check_focal = [&](const char* field, double value) {
    if (!(value > 0 && value <= 1e6)) {
      wrong(field, Str("is ", value, " px; it must be above 0 and at most 1000000 px"));
    }
  };
  const auto check_centre = [&](const char* field, double value, int size) {
    if (is_size(size) && !(value >= 0 && value <= size - 1)) {
      wrong(field, Str("is ", value, " px; the principal point must lie inside the picture, 0 .. ",
                       size - 1, " px"));
    }
  };
  check_size("width", camera.width);
  check_size("height", camera.height);
  check_focal("fx_px", camera.fx_px);
  check_focal("fy_px", camera.fy_px);
  check_centre("cx_px", camera.cx_px, camera.width);
  check_centre("cy_px", camera.cy_px, camera.height);
  const std::array<std::pair<const char*, double>, 5> coefficients = {{{"k1", camera.k1},
                                                                       {"k2", camera.k2},
                                                                       {"p1", camera.p1},
                                                                       {"p2", camera.p2},
                                                                       {"k3", camera.k3}}};
  for (const auto& [field, value] : coefficients) {
    if (!(std::abs(value) <= 1e3)) {
      wrong(field, Str("is ", value, "; a distortion coefficient must be -1000 .. 1000"));
    }
  }
}

// Largest deviation of R R^T from the unit matrix.
double OrthonormalityError(const std::array<double, 9>& r) {
  double error = 0;
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j < 3; ++j) {
      double dot = 0;
      for (size_t k = 0; k < 3; ++k) dot += r[3 * i + k] * r[3 * j + k];
      const double deviation = std::abs(dot - (i == j ? 1 : 0));
      if (!(deviation <= error)) error = deviation;  // keeps a NaN
    }
  }
  return error;
}

double Determinant(const std::array<double, 9>& r) {
  return r[0] * (r[4] * r[8] - r[5] * r[7]) - r[1] * (r[3] * r[8] - r[5] * r[6]) +
         r[2] * (r[3] * r[7] - r[4] * r[6]);
}

void CheckRotation(const std::array<double, 9>& rotation, std::vector<Fault>* faults) {
  const char* const field = "right_from_left.rotation";
  const double error = OrthonormalityError(rotation);
  if (!(error <= kRotationTolerance)) {
    faults->push_back({field, Str("is no rotation: its rows deviate from orthonormal by ", error,
                                  "; at most 1e-6 is allowed")});
  } else if (Determinant(rotation) < 0) {
    faults->push_back({field, "is a reflection (determinant -1), not a rotation"});
  }
}

void CheckTranslation(const StereoRig& rig, std::vector<Fault>* faults) {
  const char* const field = "right_from_left.translation_m";
  // Where the right camera is, in the left one's frame: -R^T t.
  const std::array<double, 9>& r = rig.right_from_left_rotation;
  const std::array<double, 3>& t = rig.right_from_left_translation_m;
  std::array<double, 3> right_in_left{};
  for (size_t i = 0; i < 3; ++i) {
    right_in_left[i] = -(r[i] * t[0] + r[3 + i] * t[1] + r[6 + i] * t[2]);
  }
  const auto [x, y, z] = right_in_left;
  const double baseline = std::sqrt(x * x + y * y + z * z);
  if (!(baseline >= kLeastBaselineM && baseline <= kLargestBaselineM)) {
    faults->push_back({field, Str("puts the cameras ", baseline,
                                  " m apart; it must be 0.0001 .. 100 m (is the unit metres?)")});
  } else if (x < 0 && -x > std::abs(y) && -x > std::abs(z)) {
    faults->push_back({field, Str("puts the right camera ", -x,
                                  " m to the left of the left one; exchange the cameras")});
  } else if (x <= std::abs(y) || x <= std::abs(z)) {
    faults->push_back({field, Str("puts the right camera at (", x, ", ", y, ", ", z,
                                  ") m from the left one; it must be mostly to its right")});
  }
}

}  // namespace

Status ValidateRig(const StereoRig& rig) {
  std::vector<Fault> faults;
  CheckCamera(rig.left, "left", &faults);
  CheckCamera(rig.right, "right", &faults);
  CheckRotation(rig.right_from_left_rotation, &faults);
  CheckTranslation(rig, &faults);
  if (faults.empty()) return {};
  const std::string message = Str("stereo rig \"", rig.name, "\": ", faults.size(),
                                  faults.size() == 1 ? " field is wrong" : " fields are wrong");
  return Status(StatusCode::kInvalidArgument, message, std::move(faults));
}

}  // namespace vs
