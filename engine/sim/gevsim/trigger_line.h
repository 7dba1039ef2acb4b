#pragma once

#include <cstdint>
#include <functional>
#include <thread>

#include "engine/base/mutex.h"

namespace vs::sim {

// A wire to the trigger inputs of all cameras. Pulses come at whole multiples of the period on the
// monotonic clock; every camera gets the same instant.
class TriggerLine {
 public:
  // `pulse` is called on the line's thread, once for each pulse, as soon as its instant has come.
  // A period of 0 means no pulses but those of Fire.
  TriggerLine(int64_t period_ns, std::function<void(int64_t instant_ns)> pulse);
  ~TriggerLine();

  // One pulse now, from any thread.
  void Fire();

 private:
  void Run();

  const int64_t period_ns_;
  const std::function<void(int64_t)> pulse_;
  Mutex mutex_;
  CondVar changed_;
  bool quit_ VS_GUARDED_BY(mutex_) = false;
  std::thread thread_;
};

}  // namespace vs::sim
