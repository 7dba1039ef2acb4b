#include "server/services/gpus.h"

namespace vs {

void AddGpus(const Result<std::vector<gpu::DeviceInfo>>& gpus,
             visionserver::v1::GetResourcesResponse* resources) {
  if (!gpus) {
    resources->set_no_gpu_reason(gpus.error().message());
    return;
  }
  for (const gpu::DeviceInfo& info : *gpus) {
    visionserver::v1::Gpu* added = resources->add_gpus();
    added->set_name(info.name);
    added->set_memory_bytes(info.memory_bytes);
    added->set_compute_capability(info.compute);
    added->set_driver_cuda_version(info.driver);
  }
}

}  // namespace vs
