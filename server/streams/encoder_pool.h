#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "engine/base/clock.h"
#include "engine/base/mutex.h"
#include "server/rpc/executor.h"
#include "server/streams/frame_encoder.h"

namespace vs {

// The threads that pack frames, so that neither vision nor the network waits for it. Thread-safe.
class EncoderPool {
 public:
  EncoderPool(int threads, const Clock& clock);

  // Runs `task` on one of the threads. False: too much waits already, and the task is not run.
  bool Post(std::function<void(FrameEncoder&)> task);
  // Runs `task` on this thread, for what takes only microseconds.
  void RunHere(const std::function<void(FrameEncoder&)>& task) VS_EXCLUDES(mutex_);

 private:
  const Clock& clock_;
  Mutex mutex_;
  std::vector<std::unique_ptr<FrameEncoder>> idle_ VS_GUARDED_BY(mutex_);
  Executor threads_;  // last: it goes first
};

}  // namespace vs
