#include "engine/stereo/quality.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "engine/base/str.h"

namespace vs {
namespace {

PixelRect Inside(const PixelRect& region, int width, int height) {
  const auto clip = [](int64_t value, int limit) {
    return static_cast<int>(std::clamp<int64_t>(value, 0, limit));
  };
  const int x = clip(region.x, width);
  const int y = clip(region.y, height);
  return {x, y, clip(int64_t{region.x} + region.width, width) - x,
          clip(int64_t{region.y} + region.height, height) - y};
}

template <class Visit>
void ForEachPixel(const PixelRect& region, int width, int height, Visit visit) {
  const PixelRect inside = Inside(region, width, height);
  for (int y = inside.y; y < inside.y + inside.height; ++y) {
    for (int x = inside.x; x < inside.x + inside.width; ++x) visit(x, y);
  }
}

double Percent(double part, double whole) { return whole > 0 ? 100 * part / whole : 0; }

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

std::vector<Sample> SamplesOf(const DepthMap& map, const PixelRect& region) {
  std::vector<Sample> samples;
  const RectifiedGeometry& g = map.geometry;
  ForEachPixel(region, map.depth_m.width(), map.depth_m.height(), [&](int x, int y) {
    const double z = map.depth_m.Row(y)[x];
    if (!(std::isfinite(z) && z > 0)) return;
    samples.push_back({(x - g.cx_px) / g.focal_px, (y - g.cy_px) / g.focal_px, 1 / z});
  });
  return samples;
}

// Least squares over the samples whose nearness is within `limit` of the plane's (all samples
// without a plane).
std::optional<Plane> FitOnce(const std::vector<Sample>& samples, const std::optional<Plane>& plane,
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
double OutlierLimit(const std::vector<Sample>& samples, const Plane& plane,
                    std::vector<double>* scratch) {
  scratch->clear();
  for (const Sample& s : samples) scratch->push_back(std::abs(plane.Nearness(s) - s.q));
  const auto middle = scratch->begin() + static_cast<std::ptrdiff_t>(scratch->size() / 2);
  std::nth_element(scratch->begin(), middle, scratch->end());
  // 1.4826: the standard deviation of a normal distribution over its median absolute deviation.
  return std::max(3 * 1.4826 * *middle, 1e-9);
}

}  // namespace

double ValidPercent(const DisparityMap& map, const PixelRect& region) {
  double valid = 0;
  double pixels = 0;
  ForEachPixel(region, map.disparity.width(), map.disparity.height(), [&](int x, int y) {
    ++pixels;
    valid += map.disparity.Row(y)[x] != kInvalidDisparity ? 1 : 0;
  });
  return Percent(valid, pixels);
}

Result<PlaneFit> FitPlane(const DepthMap& map, const PixelRect& region) {
  constexpr int kRounds = 5;
  constexpr size_t kLeastSamples = 16;
  if (map.geometry.focal_px <= 0) {
    return FailedPrecondition("plane fit: the depth map's focal length is not known");
  }
  const std::vector<Sample> samples = SamplesOf(map, region);
  if (samples.size() < kLeastSamples) {
    return FailedPrecondition(Str("plane fit: the region has ", samples.size(),
                                  " valid pixels; it needs at least ", kLeastSamples));
  }
  std::optional<Plane> plane = FitOnce(samples, std::nullopt, 0);
  std::vector<double> scratch;
  double limit = 0;
  for (int round = 0; round < kRounds && plane; ++round) {
    limit = OutlierLimit(samples, *plane, &scratch);
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
  fit.used_percent = Percent(static_cast<double>(fit.pixels), static_cast<double>(samples.size()));
  return fit;
}

Result<TruthScore> ScoreAgainstTruth(const DisparityMap& map, const StereoTruth& truth,
                                     const PixelRect& region) {
  const int width = map.disparity.width();
  const int height = map.disparity.height();
  if (!map.disparity.SameSizeAs(truth.disparity_px) || !map.disparity.SameSizeAs(truth.visible)) {
    return InvalidArgument(Str("the disparity map has ", width, " x ", height, " px, its truth ",
                               truth.disparity_px.width(), " x ", truth.disparity_px.height(),
                               " px; they must be equal"));
  }
  TruthScore score;
  double valid = 0;
  double bad1 = 0;
  double bad2 = 0;
  double error_sum = 0;
  double close = 0;
  double close_error_sum = 0;
  double depth_bias_sum = 0;
  ForEachPixel(region, width, height, [&](int x, int y) {
    const double expected = truth.disparity_px.Row(y)[x];
    if (truth.visible.Row(y)[x] == 0 || std::isnan(expected)) return;
    ++score.pixels;
    const uint16_t stored = map.disparity.Row(y)[x];
    if (stored == kInvalidDisparity) return;
    const double found = static_cast<double>(stored) / kDisparityScale + map.offset_px;
    const double error = found - expected;
    ++valid;
    bad1 += std::abs(error) > 1 ? 1 : 0;
    bad2 += std::abs(error) > 2 ? 1 : 0;
    error_sum += std::abs(error);
    if (std::abs(error) > 1) return;
    ++close;
    close_error_sum += error;
    const double doffs = map.geometry.principal_offset_px;
    if (found + doffs > 0) depth_bias_sum += (expected + doffs) / (found + doffs) - 1;
  });
  const auto pixels = static_cast<double>(score.pixels);
  score.valid_percent = Percent(valid, pixels);
  score.bad1_percent = Percent(pixels - valid + bad1, pixels);
  score.bad2_percent = Percent(pixels - valid + bad2, pixels);
  score.valid_bad1_percent = Percent(bad1, valid);
  score.valid_bad2_percent = Percent(bad2, valid);
  score.average_error_px = valid > 0 ? error_sum / valid : 0;
  score.mean_error_px = close > 0 ? close_error_sum / close : 0;
  score.depth_bias_percent = Percent(depth_bias_sum, close);
  return score;
}

}  // namespace vs
