#include "client/depth_frame.h"

#include <algorithm>

namespace vs::client {
namespace {

std::optional<double> ValueAt(const DepthFrame& frame, int x, int y) {
  if (x < 0 || y < 0 || x >= frame.width || y >= frame.height) return std::nullopt;
  const uint16_t value = frame.values[static_cast<size_t>(y) * frame.width + x];
  if (value == 0) return std::nullopt;
  return value * frame.scale + frame.offset;
}

// Disparity and depth turn into each other by the same equation.
std::optional<double> Converted(const Geometry& geometry, double value, double value_offset,
                                double result_offset) {
  if (geometry.focal_px <= 0 || value + value_offset <= 0) return std::nullopt;
  return geometry.focal_px * geometry.baseline_m / (value + value_offset) - result_offset;
}

}  // namespace

std::optional<double> DepthFrame::DisparityAt(int x, int y) const {
  const std::optional<double> value = ValueAt(*this, x, y);
  if (!value || quantity == Quantity::kDisparityPx) return value;
  return Converted(geometry, *value, 0, geometry.principal_offset_px);
}

std::optional<double> DepthFrame::DepthAt(int x, int y) const {
  const std::optional<double> value = ValueAt(*this, x, y);
  if (!value || quantity == Quantity::kDepthM) return value;
  return Converted(geometry, *value, geometry.principal_offset_px, 0);
}

std::optional<Point> DepthFrame::PointAt(int x, int y) const {
  const std::optional<double> depth_m = DepthAt(x, y);
  if (!depth_m || geometry.focal_px <= 0) return std::nullopt;
  return Point{.x_m = (x - geometry.cx_px) * *depth_m / geometry.focal_px,
               .y_m = (y - geometry.cy_px) * *depth_m / geometry.focal_px,
               .z_m = *depth_m};
}

std::optional<double> DepthFrame::MedianDepth(const Roi& roi) const {
  std::vector<double> depths_m;
  for (int y = std::max(roi.y, 0); y < std::min(roi.y + roi.height, height); ++y) {
    for (int x = std::max(roi.x, 0); x < std::min(roi.x + roi.width, width); ++x) {
      if (const std::optional<double> depth_m = DepthAt(x, y)) depths_m.push_back(*depth_m);
    }
  }
  if (depths_m.empty()) return std::nullopt;
  const auto middle = depths_m.begin() + static_cast<std::ptrdiff_t>(depths_m.size() / 2);
  std::nth_element(depths_m.begin(), middle, depths_m.end());
  return *middle;
}

double DepthFrame::ValidShare() const {
  if (values.empty()) return 0;
  const auto invalid = std::count(values.begin(), values.end(), 0);
  return 1.0 - static_cast<double>(invalid) / static_cast<double>(values.size());
}

}  // namespace vs::client
