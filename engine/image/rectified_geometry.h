#pragma once

namespace vs {

// The pinhole geometry of a rectified stereo pair: both views share the focal length and the row,
// so a point at depth_m appears in the left view at x and in the right view at x - disparity_px:
//   disparity_px = focal_px * baseline_m / depth_m - principal_offset_px
// A point (x, y) at depth Z lies, in the left view's frame (x right, y down, z forward), at
//   ((x - cx_px) * Z / focal_px, (y - cy_px) * Z / focal_px, Z).
struct RectifiedGeometry {
  int width = 0;   // px
  int height = 0;  // px
  double focal_px = 0;
  double baseline_m = 0;
  double cx_px = 0;  // principal point of the left view; pixel centres are integers
  double cy_px = 0;
  double principal_offset_px = 0;  // right view's cx minus left view's cx ("doffs" of Middlebury)

  bool operator==(const RectifiedGeometry&) const = default;
};

// The geometry after shrinking (or growing) both views by whole-image factors, for example 0.5 for
// 2 x 2 binning. Pixel centres are integers, hence the half-pixel shift of the principal point.
inline RectifiedGeometry Scaled(const RectifiedGeometry& g, int width, int height) {
  const double sx = static_cast<double>(width) / g.width;
  const double sy = static_cast<double>(height) / g.height;
  RectifiedGeometry scaled = g;
  scaled.width = width;
  scaled.height = height;
  scaled.focal_px = g.focal_px * sx;
  scaled.cx_px = (g.cx_px + 0.5) * sx - 0.5;
  scaled.cy_px = (g.cy_px + 0.5) * sy - 0.5;
  scaled.principal_offset_px = g.principal_offset_px * sx;
  return scaled;
}

}  // namespace vs
