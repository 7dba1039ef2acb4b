#include "engine/sim/gevsim/trigger_line.h"

#include <sys/prctl.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "engine/base/clock.h"

namespace vs::sim {

TriggerLine::TriggerLine(int64_t period_ns, std::function<void(int64_t)> pulse)
    : period_ns_(period_ns), pulse_(std::move(pulse)) {
  if (period_ns_ > 0) thread_ = std::thread([this] { Run(); });
}

TriggerLine::~TriggerLine() {
  {
    MutexLock lock(mutex_);
    quit_ = true;
    changed_.NotifyAll();
  }
  if (thread_.joinable()) thread_.join();
}

void TriggerLine::Fire() { pulse_(SystemClock().MonotonicNs()); }

void TriggerLine::Run() {
  prctl(PR_SET_NAME, "gevsim-line");
  prctl(PR_SET_TIMERSLACK, 1000);
  const SystemClock clock;
  int64_t next_ns = (clock.MonotonicNs() / period_ns_ + 1) * period_ns_;
  while (true) {
    {
      MutexLock lock(mutex_);
      for (int64_t now_ns = clock.MonotonicNs(); !quit_ && now_ns < next_ns;
           now_ns = clock.MonotonicNs()) {
        changed_.WaitFor(mutex_, std::chrono::nanoseconds(next_ns - now_ns));
      }
      if (quit_) return;
    }
    pulse_(next_ns);
    // A host that was away does not catch up: pulses in the past would be a lie.
    next_ns = std::max(next_ns + period_ns_, clock.MonotonicNs() / period_ns_ * period_ns_);
  }
}

}  // namespace vs::sim
