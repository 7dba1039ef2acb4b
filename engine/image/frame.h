#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "engine/image/image.h"
#include "engine/image/rectified_geometry.h"

namespace vs {

// One picture of one camera.
struct Frame {
  GreyImage image;           // 8-bit grey
  std::string camera;        // serial number or another stable name of the camera
  uint64_t number = 0;       // counts this camera's frames since start, never repeats, gaps = lost
  uint64_t trigger = 0;      // sequence number of the trigger, equal in all cameras it reached;
                             // 0 when the camera cannot tell
  int64_t timestamp_ns = 0;  // exposure, by the camera's own clock
  int64_t capture_ns = 0;    // the same instant on the host's monotonic clock (estimated)
  int64_t arrival_ns = 0;    // when the whole frame was in host memory, monotonic clock
  double exposure_us = 0;    // 0 when unknown
};
using FramePtr = std::shared_ptr<const Frame>;

// What a source knows about the true scene, for measuring a matcher. Same size as the left view it
// belongs to.
struct StereoTruth {
  Image<float> disparity_px;  // of the left view; NaN where unknown
  GreyImage visible;          // 255 where the point is seen by both cameras, else 0
};

// Two pictures of the same instant.
struct StereoFrame {
  FramePtr left;
  FramePtr right;
  uint64_t number = 0;  // counts pairs since start, gaps = pairs that were lost or dropped
  int64_t skew_ns = 0;  // right capture minus left capture
  // Set once both views are rectified; empty for raw pictures.
  std::optional<RectifiedGeometry> geometry;
  // Of these very pictures; null when the source knows none or a later step moved the pixels.
  std::shared_ptr<const StereoTruth> truth;
};

}  // namespace vs
