#pragma once

#include <array>
#include <memory>

#include "engine/base/status.h"
#include "engine/calibration/remap.h"
#include "engine/image/buffer.h"
#include "engine/image/frame.h"
#include "engine/image/rectified_geometry.h"
#include "engine/image/stereo_rig.h"

namespace vs {

struct RectifyOptions {
  // 0: only pixels that both cameras saw, so the view is a little narrower; 1: everything that
  // either camera saw, with black borders. 0..1.
  double alpha = 0;
  Interpolation interpolation = Interpolation::kLinear;

  bool operator==(const RectifyOptions&) const = default;
};

// Turns pictures of a real pair of cameras into those of an ideal one: no distortion, parallel
// axes, equal rows (Bouguet's method, as in OpenCV's stereoRectify). The maps are computed once;
// after that it is immutable and may be used by several threads.
class Rectifier {
 public:
  // For pictures of width x height pixels: the calibrated size or the same field of view shrunk,
  // for example by binning. INVALID_ARGUMENT when the rig is invalid, the two cameras differ in
  // size, or width x height has another aspect ratio than the calibrated pictures.
  static Result<Rectifier> Make(const StereoRig& rig, int width, int height,
                                const RectifyOptions& options = {});

  // The same pair with rectified pictures and their geometry; no truth, for its pixels moved.
  // Pixels that no camera saw are 0. INVALID_ARGUMENT when a picture has another size.
  Result<StereoFrame> Rectify(const StereoFrame& raw, BufferPool& pool) const;

  const RectifiedGeometry& geometry() const;
  // Row-major; a direction in the left camera's frame, seen in the rectified left frame.
  const std::array<double, 9>& rectified_from_left_rotation() const;

 private:
  struct Maps;
  explicit Rectifier(std::shared_ptr<const Maps> maps);

  std::shared_ptr<const Maps> maps_;
};

}  // namespace vs
