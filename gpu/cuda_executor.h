#pragma once

#include <memory>

#include "engine/base/status.h"
#include "gpu/executor.h"

namespace vs::gpu {

// For tests.
struct CudaExecutorOptions {
  // Before each frame all memory is filled with what no stage may rely on.
  bool poison = false;
  // In this frame, counted from 1, a kernel writes where it must not, which spoils the context of
  // all executors on the device; 0: in none.
  int spoil_frame = 0;
};

// Errors: those of Devices(); NOT_FOUND if there is no device of this index; FAILED_PRECONDITION if
// the program has no code for it; RESOURCE_EXHAUSTED when its memory is taken; UNAVAILABLE when it
// does not work. A device that an error has left in no state to go on is reset first; the executors
// that it had are then of no more use, the maps that they made stay.
Result<std::unique_ptr<Executor>> MakeCudaExecutor(int device, const CudaExecutorOptions& options);

}  // namespace vs::gpu
