#include "server/rpc/timer.h"

#include <chrono>
#include <utility>

namespace vs {

Timer::Timer() : thread_([this] { Run(); }) {}

Timer::~Timer() {
  {
    MutexLock lock(mutex_);
    stopping_ = true;
  }
  changed_.NotifyAll();
}

void Timer::At(int64_t time_ns, std::function<void()> function) {
  {
    MutexLock lock(mutex_);
    due_.emplace(time_ns, std::move(function));
  }
  changed_.NotifyAll();
}

void Timer::Run() {
  while (true) {
    std::function<void()> function;
    {
      MutexLock lock(mutex_);
      while (!stopping_ && (due_.empty() || due_.begin()->first > clock_.MonotonicNs())) {
        if (due_.empty()) {
          changed_.Wait(mutex_);
        } else {
          changed_.WaitFor(mutex_,
                           std::chrono::nanoseconds(due_.begin()->first - clock_.MonotonicNs()));
        }
      }
      if (stopping_) return;
      function = std::move(due_.begin()->second);
      due_.erase(due_.begin());
    }
    function();
  }
}

}  // namespace vs
