#pragma once

#include <cstdint>
#include <memory>

#include "engine/image/buffer.h"
#include "engine/image/frame.h"

namespace vs::sim {

struct IdealStereoSettings {
  int binning = 2;    // 1: 1296 x 966, 2: 648 x 483
  double noise = 1;   // 0 = none, 1 = as a real camera's
  uint64_t seed = 1;  // of the noise
};

// Rectified pairs of the demo scene together with their truth: for measuring a matcher without
// cameras. For one thread at a time.
class IdealStereo {
 public:
  explicit IdealStereo(const IdealStereoSettings& settings);
  ~IdealStereo();
  IdealStereo(IdealStereo&&) noexcept;

  // The scene at `instant_ns`, complete: both frames, geometry and truth. Timestamps and capture
  // are the instant; arrival is left to the caller. The same for the same arguments on every CPU.
  StereoFrame Capture(int64_t instant_ns, uint64_t number, BufferPool& pool);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace vs::sim
