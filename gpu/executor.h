#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>

#include "engine/base/status.h"
#include "engine/image/buffer.h"
#include "engine/image/image.h"
#include "engine/stereo/stereo_plan.h"

namespace vs::gpu {

// Carries frames, one after the other, through all stages on one device. Not thread-safe; errors
// leave it as it is, and after UNAVAILABLE (the device is in no state to go on) it is of no more
// use.
class Executor {
 public:
  virtual ~Executor() = default;

  // Makes room for pictures of this size that go by this valid plan of the whole picture (a region
  // is ignored), and takes its tables up; nothing happens if that was done last. RESOURCE_EXHAUSTED
  // says how many bytes are needed and how many there are.
  virtual Status Prepare(const StereoPlan& plan, int width, int height) = 0;
  // One frame: up go two pictures of the prepared size, down comes what StereoMatcher::Process
  // gives. Its memory is the executor's own, pinned for the device, or comes from `pool`.
  virtual Result<StereoResult> Run(const GreyImage& left, const GreyImage& right,
                                   BufferPool& pool) = 0;
  // Memory of the device that it holds.
  virtual size_t DeviceBytes() const = 0;
  // What the stages of the last frame took on the device, without the copies; 0 if not measured.
  virtual int64_t StagesNs() const = 0;
};

// Makes the executor of a device by its index. NOT_FOUND if there is no such device.
using ExecutorFactory = std::function<Result<std::unique_ptr<Executor>>(int device)>;

}  // namespace vs::gpu
