#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "engine/base/mutex.h"

namespace vs {

class ActiveRun;
struct FrameInFlight;

// Something that a worker can do now: one block for one frame, or letting a frame in.
struct Task {
  static constexpr int kEntry = -1;                              // as `node`
  static constexpr int kLast = std::numeric_limits<int>::max();  // as `distance`, of an entry

  ActiveRun* run = nullptr;
  int node = kEntry;
  FrameInFlight* frame = nullptr;  // null for an entry
  int priority = 0;                // of the sequence
  int distance = kLast;            // to the output
  uint64_t age = 0;                // smaller = older
};

// The ready tasks of all runs, and the lock behind which runs decide what is ready.
//
// Order: higher priority, then nearer the output, then older. Letting a frame in comes after
// everything else of its priority, so what has been begun is finished first and a sequence that
// always has frames cannot keep an equal one out.
class TaskQueue {
 public:
  // Guards the queue and the scheduling state of every run.
  Mutex mutex;

  // A worker that pushes and then takes need not call Kick().
  void Push(const Task& task) VS_REQUIRES(mutex);
  // Wakes a sleeping worker if there is something to do.
  void Kick() VS_REQUIRES(mutex);
  // Drops all tasks of the run; gives their number.
  int Remove(const ActiveRun* run) VS_REQUIRES(mutex);
  // Keeps room for so many more tasks, so that Push takes no memory.
  void Reserve(size_t tasks) VS_REQUIRES(mutex);
  void Unreserve(size_t tasks) VS_REQUIRES(mutex) { room_ -= tasks; }
  // 1, 2, 3 ...
  uint64_t NextAge() VS_REQUIRES(mutex) { return ++age_; }

  // Waits for a task. False when the queue is closed.
  bool Take(Task* task) VS_EXCLUDES(mutex);
  void Close() VS_EXCLUDES(mutex);

 private:
  CondVar available_;
  std::vector<Task> heap_ VS_GUARDED_BY(mutex);
  size_t room_ VS_GUARDED_BY(mutex) = 0;
  uint64_t age_ VS_GUARDED_BY(mutex) = 0;
  int sleeping_ VS_GUARDED_BY(mutex) = 0;
  bool closed_ VS_GUARDED_BY(mutex) = false;
};

}  // namespace vs
