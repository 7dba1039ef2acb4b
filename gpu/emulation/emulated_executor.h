#pragma once

#include <cstdint>
#include <memory>
#include <utility>

#include "gpu/executor.h"
#include "gpu/kernels/simt.h"

namespace vs::gpu {

// Launches kernels on the CPU: stages take this or what launches them on a device.
class EmulatedLaunch {
 public:
  explicit EmulatedLaunch(uint32_t seed) : seed_(seed) {}

  template <class... Params, class... Args>
  void operator()(void (*kernel)(Params...), Grid grid, int threads_in_block, Args&&... args) {
    emulation::Run(grid, threads_in_block, ++seed_, [&] { kernel(static_cast<Params>(args)...); });
  }

 private:
  uint32_t seed_;
};

// All stages on the CPU, in memory that is poisoned before each frame. For tests: very
// much slower than a device.
std::unique_ptr<Executor> MakeEmulatedExecutor(uint32_t seed);

}  // namespace vs::gpu
