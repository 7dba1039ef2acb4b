#pragma once

#include <functional>
#include <memory>

#include "engine/base/clock.h"
#include "engine/stereo/stereo_matcher.h"
#include "gpu/device_board.h"
#include "gpu/executor.h"

namespace vs::gpu {

struct CudaMatcherOptions {
  ExecutorFactory make_executor;
  MatcherFactory make_substitute;  // who works while the device does not
  const Clock* clock = nullptr;
  DeviceBoard* board = nullptr;
};

// The matcher of a device (or of DeviceBoard::kAny). A frame is never lost to a device that reports
// an error (one that hangs holds its frame):
//   - RESOURCE_EXHAUSTED is passed up: the frame needs more memory than there is.
//   - Any other error: the executor is made anew, once in kForgetNs, and gets the frame again.
//   - If that does not help, a substitute takes the frame and all that follow, and the board is
//     told. After each kForgetNs one frame tries the device again.
// By kAny a device that refuses is passed over while there are others.
// Errors: NOT_FOUND as DeviceBoard::Take; RESOURCE_EXHAUSTED and FAILED_PRECONDITION as
// `make_executor`; what `make_substitute` says if that is needed.
inline constexpr int64_t kForgetNs = int64_t{60} * 1'000'000'000;
Result<std::unique_ptr<StereoMatcher>> MakeCudaMatcher(const CudaMatcherOptions& options,
                                                       int device);

}  // namespace vs::gpu
