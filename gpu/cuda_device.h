// A device as CUDA's runtime knows it. Only for the files that are built with CUDA.
#pragma once

#include <cuda_runtime_api.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <shared_mutex>

#include "engine/base/status.h"
#include "engine/image/buffer.h"

namespace vs::gpu {

// All executors on a device share its context. An error that spoils the context spoils it for all,
// and only a reset helps, which takes from all of them what they had there. So whoever calls CUDA
// enters first, with the generation in which he began; a reset waits until nobody is inside and
// begins a new generation. Thread-safe.
class CudaDevice {
 public:
  // By an index that Devices() has.
  static CudaDevice& Of(int index);

  explicit CudaDevice(int index) : index_(index) {}

  using Use = std::shared_lock<std::shared_mutex>;
  // While the result lives, the device is this thread's current one and is not reset. UNAVAILABLE
  // if it failed, or was reset since `generation`. Never enter twice at once.
  Result<Use> Enter(uint64_t generation);
  // Resets the device if it failed. Gives the generation that has begun.
  Result<uint64_t> Revive();

  // OK, or what went wrong in `call`: RESOURCE_EXHAUSTED for memory, UNAVAILABLE if the context is
  // spoilt, which is noted, INTERNAL for the rest.
  Status Check(cudaError_t error, const char* call);

  int index() const { return index_; }

 private:
  const int index_;
  std::shared_mutex resetting_;
  std::atomic<bool> failed_ = false;
  std::atomic<uint64_t> generation_ = 1;
};

// For pools whose memory the device copies from and to. It is our own memory, made known to the
// device, so that it stays for its readers when the device is reset.
std::shared_ptr<MemoryPinner> MakePinner(CudaDevice& device, uint64_t generation);

}  // namespace vs::gpu
