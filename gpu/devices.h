// The GPUs of this machine. Nothing here touches CUDA before it is first asked, so that a program
// can block its signals before: CUDA starts threads of its own.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/base/status.h"
#include "gpu/device_board.h"

namespace vs::gpu {

struct DeviceInfo {
  std::string name;           // "NVIDIA H200"
  uint64_t memory_bytes = 0;  // in all
  std::string compute;        // compute capability, "9.0"
  std::string driver;         // the newest CUDA that its driver knows, "13.0"
  // Its limits, for comparison; 0 if not known.
  int multiprocessors = 0;
  double clock_hz = 0;
  double memory_bytes_per_s = 0;
};

// By index, at least one. UNAVAILABLE says why there is none: built without CUDA, no driver, no
// device. Looked for once, so a device that comes later is seen after the next start.
const Result<std::vector<DeviceInfo>>& Devices();

// Who works on Devices(), and how they do.
DeviceBoard& Board();

// Adds the matchers "cuda" and "cuda:0", "cuda:1" ... to StereoMatchers, unless this program was
// built without CUDA. Only the first call does something. For the start of a program.
void RegisterMatchers();

}  // namespace vs::gpu
