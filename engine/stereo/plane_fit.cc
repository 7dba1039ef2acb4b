#include "engine/stereo/plane_fit.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>

#include "engine/base/str.h"

namespace vs {
namespace {

// A pixel's ray (x, y, 1) and the nearness q = 1 / Z of what lies there, 1/m.
struct Sample {
  double x, y, q;
};

// All points with a X + b Y + c Z = 1; along a ray, q = a x + b y + c.
struct Plane {
  double a, b, c;

  double Norm() const { return std::sqrt(a * a + b * b + c * c); }
  double Nearness(const Sample& s) const { return a * s.x + b * s.y + c; }
  // m, of the sample's point from the plane
  double Distance(const Sample& s) const { return std::abs(Nearness(s) / s.q - 1) / Norm(); }
};

// A plane is known well enough from so many points; more only take time.
constexpr int64_t kMostSamples = 40'000;

// Which rows and columns are looked at: all of a small region, every second one of a larger ...
int StepOf(const PixelRect& region) {
  int step = 1;
  while (int64_t{region.width} * region.height > kMostSamples * step * step) ++step;
  return step;
}

// The region's samples, and room for one number for each of them.
class Samples {
 public:
  Samples(const DepthMap& map, const PixelRect& region, BufferPool& pool)
      : region_(Inside(region, map.depth_m.width(), map.depth_m.height())),
        memory_(pool.Acquire(Capacity() * (sizeof(Sample) + sizeof(double)))),
        samples_(reinterpret_cast<Sample*>(memory_.data)),
        numbers_(reinterpret_cast<double*>(samples_ + Capacity())) {
    const RectifiedGeometry& g = map.geometry;
    const int step = StepOf(region_);
    for (int y = region_.y; y < region_.y + region_.height; y += step) {
      const float* depth = map.depth_m.Row(y);
      for (int x = region_.x; x < region_.x + region_.width; x += step) {
        const double z = depth[x];
        if (!(std::isfinite(z) && z > 0)) continue;
        samples_[count_++] = {(x - g.cx_px) / g.focal_px, (y - g.cy_px) / g.focal_px, 1 / z};
      }
    }
  }

  size_t size() const { return count_; }
  const Sample* begin() const { return samples_; }
  const Sample* end() const { return samples_ + count_; }
  // The value of rank size() / 2 among value_of(sample).
  template <class ValueOf>
  double MedianOf(ValueOf value_of) const {
    std::transform(begin(), end(), numbers_, value_of);
    std::nth_element(numbers_, numbers_ + count_ / 2, numbers_ + count_);
    return numbers_[count_ / 2];
  }

 private:
  size_t Capacity() const {
    const int step = StepOf(region_);
    return static_cast<size_t>((region_.width + step - 1) / step) *
           static_cast<size_t>((region_.height + step - 1) / step);
  }

  PixelRect region_;
  Buffer memory_;
  Sample* samples_;
  double* numbers_;
  size_t count_ = 0;
};

// Least squares over the samples whose nearness is within `limit` of the plane's (all samples
// without a plane).
std::optional<Plane> FitOnce(const Samples& samples, const std::optional<Plane>& plane,
                             double limit) {
  const auto used = [&](const Sample& s) {
    return !plane || std::abs(plane->Nearness(s) - s.q) <= limit;
  };
  // About the mean, so that the normal equations stay well conditioned.
  double n = 0;
  Sample mean{0, 0, 0};
  for (const Sample& s : samples) {
    if (!used(s)) continue;
    n += 1;
    mean.x += s.x;
    mean.y += s.y;
    mean.q += s.q;
  }
  if (n < 3) return std::nullopt;
  mean = {mean.x / n, mean.y / n, mean.q / n};
  double xx = 0;
  double xy = 0;
  double yy = 0;
  double xq = 0;
  double yq = 0;
  for (const Sample& s : samples) {
    if (!used(s)) continue;
    const double x = s.x - mean.x;
    const double y = s.y - mean.y;
    xx += x * x;
    xy += x * y;
    yy += y * y;
    xq += x * (s.q - mean.q);
    yq += y * (s.q - mean.q);
  }
  const double determinant = xx * yy - xy * xy;
  if (determinant <= 1e-9 * (xx + yy) * (xx + yy)) return std::nullopt;
  const double a = (xq * yy - yq * xy) / determinant;
  const double b = (yq * xx - xq * xy) / determinant;
  return Plane{a, b, mean.q - a * mean.x - b * mean.y};
}

// Three robust standard deviations of the nearness.
double OutlierLimit(const Samples& samples, const Plane& plane) {
  const double median =
      samples.MedianOf([&](const Sample& s) { return std::abs(plane.Nearness(s) - s.q); });
  // 1.4826: the standard deviation of a normal distribution over its median absolute deviation.
  return std::max(3 * 1.4826 * median, 1e-9);
}

}  // namespace

Result<PlaneFit> FitPlane(const DepthMap& map, const PixelRect& region, BufferPool& pool) {
  constexpr int kRounds = 5;
  constexpr size_t kLeastSamples = 16;
  if (map.geometry.focal_px <= 0) {
    return FailedPrecondition("plane fit: the depth map's focal length is not known");
  }
  const Samples samples(map, region, pool);
  if (samples.size() < kLeastSamples) {
    return FailedPrecondition(Str("plane fit: the region has ", samples.size(),
                                  " valid pixels; it needs at least ", kLeastSamples));
  }
  std::optional<Plane> plane = FitOnce(samples, std::nullopt, 0);
  double limit = 0;
  for (int round = 0; round < kRounds && plane; ++round) {
    limit = OutlierLimit(samples, *plane);
    plane = FitOnce(samples, plane, limit);
  }
  if (!plane) return FailedPrecondition("plane fit: the region's points do not span a plane");
  PlaneFit fit;
  double squares = 0;
  for (const Sample& s : samples) {
    if (std::abs(plane->Nearness(s) - s.q) > limit) continue;
    ++fit.pixels;
    squares += plane->Distance(s) * plane->Distance(s);
  }
  fit.rms_m = std::sqrt(squares / std::max<double>(1, static_cast<double>(fit.pixels)));
  fit.distance_m = 1 / plane->Norm();
  fit.tilt_deg = std::acos(std::abs(plane->c) / plane->Norm()) * 180 / std::numbers::pi;
  fit.used_percent = 100 * static_cast<double>(fit.pixels) / static_cast<double>(samples.size());
  return fit;
}

}  // namespace vs
