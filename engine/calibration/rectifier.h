#pragma once

#include <array>
#include <memory>

#include "engine/base/status.h"
#include "engine/image/buffer.h"
#include "engine/image/frame.h"
#include "engine/image/rectification.h"
#include "engine/image/stereo_rig.h"

namespace vs {

struct RectifyOptions {
  // 0: only pixels that both cameras saw, so the view is a little narrower; 1: everything that
  // either camera saw, with black borders. 0..1.
  double alpha = 0;
  Interpolation interpolation = Interpolation::kLinear;
  // Where pixels come from is known to 1/32 px, or exactly. The former shows as a faint ripple in
  // sub-pixel disparities and takes less time.
  bool exact_maps = false;
  // Half the size: pictures are binned 2 x 2 first, because to take every second pixel would alias.
  bool half_size = false;

  bool operator==(const RectifyOptions&) const = default;
};

// Turns pictures of a real pair of cameras into those of an ideal one: no distortion, parallel
// axes, equal rows (Bouguet's method, as in OpenCV's stereoRectify). The maps are computed once;
// after that it is immutable and may be used by several threads.
class Rectifier {
 public:
  // For pictures of width x height pixels: the calibrated size, an exact multiple of it, or what a
  // camera makes of it when it bins n x n pixels (n = 2 .. 16): it drops the rest of rows and
  // columns, and some cameras one more to get an even size. INVALID_ARGUMENT for any other size,
  // when the rig is invalid or when the two cameras differ in size. The result has 16 px or more.
  //
  // The size alone tells how a picture came about: a window of the sensor as large as a binned
  // picture is taken for one, and rectified wrongly. Calibrate a window as it is.
  static Result<Rectifier> Make(const StereoRig& rig, int width, int height,
                                const RectifyOptions& options = {});

  // Never null, and the same object for copies of this rectifier.
  std::shared_ptr<const Rectification> rectification() const;
  // Whether it was made for pictures of this size.
  bool Fits(int width, int height) const;
  // The same pair with rectified pictures and their geometry; no truth, for its pixels moved.
  // Pixels that no camera saw are 0. INVALID_ARGUMENT when a picture has another size.
  Result<StereoFrame> Rectify(const StereoFrame& raw, BufferPool& pool) const;

  // That of rectification().
  const RectifiedGeometry& geometry() const;
  // Row-major; a direction in the left camera's frame, seen in the rectified left frame.
  const std::array<double, 9>& rectified_from_left_rotation() const;

 private:
  struct Maps;
  explicit Rectifier(std::shared_ptr<const Maps> maps);

  std::shared_ptr<const Maps> maps_;
};

}  // namespace vs
