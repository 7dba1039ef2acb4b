// What devices.h and cuda_executor.h say where there is no CUDA.
#include "gpu/cuda_executor.h"
#include "gpu/devices.h"

namespace vs::gpu {

const Result<std::vector<DeviceInfo>>& Devices() {
  static const Result<std::vector<DeviceInfo>> none =
      Unavailable("this program is built without CUDA");
  return none;
}

Result<std::unique_ptr<Executor>> MakeCudaExecutor(int /*device*/,
                                                   const CudaExecutorOptions& /*options*/) {
  return Devices().error();
}

DeviceBoard& Board() {
  static DeviceBoard board(0);
  return board;
}

void RegisterMatchers() {}

}  // namespace vs::gpu
