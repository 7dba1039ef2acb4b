#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <thread>
#include <vector>

#include "engine/base/mutex.h"

namespace vs {

// A fixed number of threads that work off one bounded queue.
class Executor {
 public:
  Executor(int threads, size_t max_queued);
  // Runs what is queued, then ends.
  ~Executor();
  Executor(const Executor&) = delete;
  Executor& operator=(const Executor&) = delete;

  // Runs `task` soon on one of the threads. False: the queue is full or Stop was called, and the
  // task is not run.
  bool Post(std::function<void()> task);
  // Takes no more tasks, runs those that are queued, and returns when all threads have ended. Not
  // from one of its own threads.
  void Stop();

 private:
  void Work() VS_EXCLUDES(mutex_);

  const size_t max_queued_;
  Mutex mutex_;
  CondVar changed_;
  std::deque<std::function<void()>> queue_ VS_GUARDED_BY(mutex_);
  bool stopping_ VS_GUARDED_BY(mutex_) = false;
  std::vector<std::jthread> threads_;
};

}  // namespace vs
