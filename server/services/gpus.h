#pragma once

#include <vector>

#include "visionserver/v1/system.pb.h"

#include "engine/base/status.h"
#include "gpu/devices.h"

namespace vs {

// Tells `resources` of these GPUs, or why there are none.
void AddGpus(const Result<std::vector<gpu::DeviceInfo>>& gpus,
             visionserver::v1::GetResourcesResponse* resources);

}  // namespace vs
