#include "engine/stereo/quality.h"

#include <cmath>

#include "engine/base/str.h"

namespace vs {
namespace {

template <class Visit>
void ForEachPixel(const PixelRect& region, int width, int height, Visit visit) {
  const PixelRect inside = Inside(region, width, height);
  for (int y = inside.y; y < inside.y + inside.height; ++y) {
    for (int x = inside.x; x < inside.x + inside.width; ++x) visit(x, y);
  }
}

double Percent(double part, double whole) { return whole > 0 ? 100 * part / whole : 0; }

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
