#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <thread>

#include "engine/base/clock.h"
#include "engine/base/mutex.h"

namespace vs {

// Calls functions at given instants of the host's monotonic clock, one after the other on one
// thread of its own: they only take note (post a task, wake somebody).
class Timer {
 public:
  Timer();
  // What is not due yet is dropped.
  ~Timer();
  Timer(const Timer&) = delete;
  Timer& operator=(const Timer&) = delete;

  // Calls at `time_ns`, at once when that has passed.
  void At(int64_t time_ns, std::function<void()> function);

 private:
  void Run() VS_EXCLUDES(mutex_);

  SystemClock clock_;
  Mutex mutex_;
  CondVar changed_;
  std::multimap<int64_t, std::function<void()>> due_ VS_GUARDED_BY(mutex_);
  bool stopping_ VS_GUARDED_BY(mutex_) = false;
  std::jthread thread_;
};

}  // namespace vs
