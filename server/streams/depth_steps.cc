#include "server/streams/depth_steps.h"

#include <algorithm>
#include <cmath>

namespace vs {
namespace {

constexpr float kFarthestM = 1e6F;
constexpr double kLargestStep = 65535;

bool IsKnown(float depth_m) { return depth_m > 0 && depth_m <= kFarthestM; }  // false for NaN

float Farthest(const Image<float>& depth_m) {
  float farthest = 0;
  for (int y = 0; y < depth_m.height(); ++y) {
    const float* row = depth_m.Row(y);
    for (int x = 0; x < depth_m.width(); ++x) {
      if (IsKnown(row[x])) farthest = std::max(farthest, row[x]);
    }
  }
  return farthest;
}

double StepFor(double farthest_m) {
  double decade_m = 1e-4;
  while (true) {
    for (const double factor : {1.0, 2.0, 5.0}) {
      if (farthest_m / (factor * decade_m) <= kLargestStep) return factor * decade_m;
    }
    decade_m *= 10;
  }
}

}  // namespace

void ToSteps(const Image<float>& depth_m, DepthSteps* result) {
  result->step_m = StepFor(Farthest(depth_m));
  result->steps.resize(static_cast<size_t>(depth_m.width()) * depth_m.height());
  const float steps_per_m = static_cast<float>(1 / result->step_m);
  uint16_t* out = result->steps.data();
  for (int y = 0; y < depth_m.height(); ++y) {
    const float* row = depth_m.Row(y);
    for (int x = 0; x < depth_m.width(); ++x) {
      // The nearest that is known must not become "unknown".
      const float steps = std::clamp(std::round(row[x] * steps_per_m), 1.0F, 65535.0F);
      *out++ = IsKnown(row[x]) ? static_cast<uint16_t>(steps) : uint16_t{0};
    }
  }
}

}  // namespace vs
