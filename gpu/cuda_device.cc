#include "gpu/cuda_device.h"

#include <string>
#include <utility>
#include <vector>

#include "engine/base/check.h"
#include "engine/base/str.h"
#include "gpu/devices.h"

namespace vs::gpu {
namespace {

// After these no call on the context succeeds any more. Of some CUDA's documentation says that the
// process must be started anew: where a reset does not help, the processor goes on.
bool SpoilsContext(cudaError_t error) {
  switch (error) {
    case cudaErrorAssert:
    case cudaErrorContained:
    case cudaErrorContextIsDestroyed:
    case cudaErrorDevicesUnavailable:
    case cudaErrorDeviceUninitialized:
    case cudaErrorECCUncorrectable:
    case cudaErrorExternalDevice:
    case cudaErrorHardwareStackError:
    case cudaErrorIllegalAddress:
    case cudaErrorIllegalInstruction:
    case cudaErrorInitializationError:
    case cudaErrorInvalidAddressSpace:
    case cudaErrorInvalidPc:
    case cudaErrorLaunchFailure:
    case cudaErrorLaunchTimeout:
    case cudaErrorMisalignedAddress:
    case cudaErrorMpsClientTerminated:
    case cudaErrorNvlinkUncorrectable:
    case cudaErrorSystemNotReady:
    case cudaErrorTensorMemoryLeak:
    case cudaErrorUnknown:
      return true;
    default:
      return false;
  }
}

std::string VersionText(int version) { return Str(version / 1000, '.', version % 1000 / 10); }

double AttributeOf(int device, cudaDeviceAttr attribute) {
  int value = 0;
  return cudaDeviceGetAttribute(&value, attribute, device) == cudaSuccess ? value : 0;
}

Result<std::vector<DeviceInfo>> FindDevices() {
  int driver = 0;
  if (cudaDriverGetVersion(&driver) != cudaSuccess || driver == 0) {
    return Unavailable("no driver for NVIDIA's GPUs is installed");
  }
  int count = 0;
  const cudaError_t counted = cudaGetDeviceCount(&count);
  if (counted == cudaErrorInsufficientDriver) {
    return Unavailable(Str("the driver is too old: it knows CUDA ", VersionText(driver),
                           ", this program needs ", VersionText(CUDART_VERSION)));
  }
  if (counted == cudaErrorNoDevice || (counted == cudaSuccess && count == 0)) {
    return Unavailable("the driver finds no device");
  }
  if (counted != cudaSuccess) {
    return Unavailable(
        Str("cudaGetDeviceCount: ", cudaGetErrorName(counted), ", ", cudaGetErrorString(counted)));
  }
  std::vector<DeviceInfo> devices;
  for (int k = 0; k < count; ++k) {
    cudaDeviceProp properties{};
    const cudaError_t asked = cudaGetDeviceProperties(&properties, k);
    if (asked != cudaSuccess) {  // it keeps its place: others are told by their index
      (void)cudaGetLastError();
      devices.push_back({.name = Str("cannot be read: ", cudaGetErrorName(asked))});
      continue;
    }
    devices.push_back({.name = properties.name,
                       .memory_bytes = properties.totalGlobalMem,
                       .compute = Str(properties.major, '.', properties.minor),
                       .driver = VersionText(driver),
                       .multiprocessors = properties.multiProcessorCount,
                       .clock_hz = 1e3 * AttributeOf(k, cudaDevAttrClockRate),
                       // Two bits for each line and clock.
                       .memory_bytes_per_s = 2e3 / 8 * AttributeOf(k, cudaDevAttrMemoryClockRate) *
                                             AttributeOf(k, cudaDevAttrGlobalMemoryBusWidth)});
  }
  return devices;
}

class CudaPinner final : public MemoryPinner {
 public:
  CudaPinner(CudaDevice& device, uint64_t generation) : device_(device), generation_(generation) {}

  bool Pin(std::byte* data, size_t size_bytes) override {
    const auto use = device_.Enter(generation_);
    return use.has_value() &&
           device_
               .Check(cudaHostRegister(data, size_bytes, cudaHostRegisterPortable),
                      "cudaHostRegister")
               .ok();
  }
  void Unpin(std::byte* data) override {
    const auto use = device_.Enter(generation_);
    if (use.has_value()) (void)device_.Check(cudaHostUnregister(data), "cudaHostUnregister");
  }

 private:
  CudaDevice& device_;
  const uint64_t generation_;
};

}  // namespace

const Result<std::vector<DeviceInfo>>& Devices() {
  static const Result<std::vector<DeviceInfo>> devices = FindDevices();
  return devices;
}

CudaDevice& CudaDevice::Of(int index) {
  // Never deleted: pinned memory may outlive everything.
  static const auto* const all = [] {
    auto* made = new std::vector<std::unique_ptr<CudaDevice>>;
    const size_t count = Devices().has_value() ? Devices()->size() : 0;
    for (size_t k = 0; k < count; ++k) {
      made->push_back(std::make_unique<CudaDevice>(static_cast<int>(k)));
    }
    return made;
  }();
  VS_CHECK(index >= 0 && static_cast<size_t>(index) < all->size());
  return *(*all)[static_cast<size_t>(index)];
}

Result<CudaDevice::Use> CudaDevice::Enter(uint64_t generation) {
  const auto gone = [this] {
    return Unavailable(Str("GPU ", index_, " failed; what was in its memory is lost"));
  };
  // Before the lock, so that nobody keeps a reset waiting.
  if (failed_) return gone();
  Use use(resetting_);
  if (failed_ || generation != generation_) return gone();
  VS_RETURN_IF_ERROR(Check(cudaSetDevice(index_), "cudaSetDevice"));
  return use;
}

Result<uint64_t> CudaDevice::Revive() {
  const std::unique_lock<std::shared_mutex> alone(resetting_);
  if (failed_) {
    // What comes back may be the old error again.
    (void)cudaSetDevice(index_);
    (void)cudaDeviceReset();
    (void)cudaGetLastError();
    ++generation_;
    failed_ = false;
  }
  return generation_.load();
}

Status CudaDevice::Check(cudaError_t error, const char* call) {
  if (error == cudaSuccess) return {};
  (void)cudaGetLastError();
  const std::string message = Str("GPU ", index_, ": ", call, ": ", cudaGetErrorName(error), ", ",
                                  cudaGetErrorString(error));
  if (error == cudaErrorMemoryAllocation) return ResourceExhausted(message);
  if (!SpoilsContext(error)) return Internal(message);
  failed_ = true;
  return Unavailable(message);
}

std::shared_ptr<MemoryPinner> MakePinner(CudaDevice& device, uint64_t generation) {
  return std::make_shared<CudaPinner>(device, generation);
}

}  // namespace vs::gpu
