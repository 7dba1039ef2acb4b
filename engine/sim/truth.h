#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>

#include "engine/image/buffer.h"
#include "engine/image/frame.h"
#include "engine/image/stereo_rig.h"
#include "engine/sim/vec3.h"

namespace vs::sim {

// The rectified left view whose truth is asked for, as a rectification of the rig defines it (cv:
// stereoRectify: `rectified_from_left` is R1, the geometry is read off P1 and P2).
struct RectifiedView {
  RectifiedGeometry geometry;
  Rotation rectified_from_left = kNoRotation;
};

// What a perfect matcher would find.
struct SceneTruth {
  std::shared_ptr<const StereoTruth> stereo;
  Image<float> depth_m;  // along the rectified optical axis; NaN where there is nothing
};

// Computes the exact truth of the demo scene for one rectified view by casting rays: depth and
// disparity at every pixel's centre, and whether the other camera sees the same point. What stands
// still is computed once, so each instant costs little more than copying. For one thread at a time.
class TruthRenderer {
 public:
  // With `raw_rig`, a pixel counts as visible only where both of its raw pictures show the point
  // (the rim of a rectified picture may be empty). Leave it out for ideal views.
  explicit TruthRenderer(const RectifiedView& view,
                         const std::optional<StereoRig>& raw_rig = std::nullopt);
  ~TruthRenderer();
  TruthRenderer(TruthRenderer&&) noexcept;

  // `instant_ns` is the trigger's instant: the timestamp of a frame of `sim:`, or of gevsim after
  // DeviceClock::InstantOf (which changes nothing unless its clock is set to be wrong).
  SceneTruth At(int64_t instant_ns, BufferPool& pool);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace vs::sim
