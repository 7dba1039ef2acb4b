// What devices.h says where there is no CUDA.
#include "gpu/devices.h"

namespace vs::gpu {

const Result<std::vector<DeviceInfo>>& Devices() {
  static const Result<std::vector<DeviceInfo>> none =
      Unavailable("this program is built without CUDA");
  return none;
}

DeviceBoard& Board() {
  static DeviceBoard board(0);
  return board;
}

void RegisterMatchers() {}

}  // namespace vs::gpu
