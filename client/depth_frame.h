#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace vs::client {

// The pinhole geometry of a rectified stereo pair, see RectifiedGeometry in stream.proto.
struct Geometry {
  double focal_px = 0;  // 0: the server does not know the geometry
  double baseline_m = 0;
  double cx_px = 0;
  double cy_px = 0;
  double principal_offset_px = 0;

  bool operator==(const Geometry&) const = default;
};

// In the left camera's frame: x right, y down, z forward, metres.
struct Point {
  double x_m = 0;
  double y_m = 0;
  double z_m = 0;
};

// A step of a frame's way through the server, nanoseconds of the server's monotonic clock.
struct Stage {
  std::string name;
  int64_t start_ns = 0;
  int64_t end_ns = 0;
};

// A region of an image, pixels.
struct Roi {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
};

// What the pixels of a DepthFrame count.
enum class Quantity { kDisparityPx, kDepthM };

// One depth image, with all that is needed to turn its pixels into metres.
struct DepthFrame {
  int width = 0;
  int height = 0;
  // Row by row. 0 means that nothing is known there; else the quantity is value * scale + offset.
  std::vector<uint16_t> values;
  Quantity quantity = Quantity::kDisparityPx;
  double scale = 0;
  double offset = 0;
  // 0..255 and InvalidReason of stream.proto for each pixel; empty unless asked for.
  std::vector<uint8_t> confidence;
  std::vector<uint8_t> reason;
  Geometry geometry;

  uint64_t seq = 0;           // counts what the sequence published
  uint64_t dropped = 0;       // not seen by the caller between the previous frame and this one
  uint64_t frame_number = 0;  // of the camera
  int64_t capture_ns = 0;     // exposure, on the server's monotonic clock; see Client::ServerClock
  std::chrono::system_clock::time_point capture_time;  // the same instant in wall-clock time
  std::vector<Stage> stages;
  uint64_t sequence_revision = 0;
  uint64_t received_bytes = 0;

  // Nothing where the pixel is invalid or outside the image, or (the latter two) at infinity or
  // without geometry.
  std::optional<double> DisparityAt(int x, int y) const;  // pixels
  std::optional<double> DepthAt(int x, int y) const;      // metres along the optical axis
  std::optional<Point> PointAt(int x, int y) const;

  // The middle one of all known depths in the region, metres; nothing if there are none. Stands for
  // a surface better than a mean, which outliers pull away.
  std::optional<double> MedianDepth(const Roi& roi) const;
  // Share of pixels with a disparity, 0..1.
  double ValidShare() const;
};

}  // namespace vs::client
