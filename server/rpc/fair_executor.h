#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <map>
#include <string>

#include "engine/base/mutex.h"
#include "engine/base/status.h"
#include "server/rpc/executor.h"

namespace vs {

struct FairExecutorOptions {
  int threads = 2;
  // Of all who post.
  size_t max_waiting = 16;
  // Of each, so that none fills the queue of all.
  size_t max_waiting_each = 8;
};

// Threads for tasks that take as long as they please: of each who posts at most one task runs at a
// time, so that his slow ones keep only himself waiting. Those who wait take turns.
class FairExecutor {
 public:
  explicit FairExecutor(const FairExecutorOptions& options);
  // Runs what waits, then ends.
  ~FairExecutor();
  FairExecutor(const FairExecutor&) = delete;
  FairExecutor& operator=(const FairExecutor&) = delete;

  // Runs `task` after all that `who` has posted before. RESOURCE_EXHAUSTED: too many are waiting;
  // UNAVAILABLE: Stop was called; the task is not run.
  Status Post(const std::string& who, std::function<void()> task);
  // Takes no more tasks, runs those that wait, and returns when all threads have ended. Not from
  // one of its own threads.
  void Stop();

 private:
  void RunNextOf(const std::string& who) VS_EXCLUDES(mutex_);

  const FairExecutorOptions options_;
  Mutex mutex_;
  // What waits, by who posted it. Whoever has a task running or waiting is in it.
  std::map<std::string, std::deque<std::function<void()>>> waiting_ VS_GUARDED_BY(mutex_);
  size_t waiting_count_ VS_GUARDED_BY(mutex_) = 0;
  bool stopping_ VS_GUARDED_BY(mutex_) = false;
  // Whose turn it is next: everybody is in its queue at most once, and not while his task runs.
  Executor turns_;
};

}  // namespace vs
