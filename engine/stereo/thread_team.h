#pragma once

#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

#include "engine/base/mutex.h"

namespace vs {

// Rows [begin, end).
struct RowRange {
  int begin;
  int end;
};
// The share of `part` of `parts`: as equal as can be.
inline RowRange ShareOf(int count, int part, int parts) {
  return {static_cast<int>(int64_t{count} * part / parts),
          static_cast<int>(int64_t{count} * (part + 1) / parts)};
}

// Runs the parts of one picture's work side by side: the caller and up to size - 1 helpers, which
// wait between calls. Starting and joining costs microseconds and no heap memory. Used by one
// caller at a time.
class ThreadTeam {
 public:
  ThreadTeam() = default;
  ~ThreadTeam();
  ThreadTeam(const ThreadTeam&) = delete;
  ThreadTeam& operator=(const ThreadTeam&) = delete;

  // Calls work(part) once for each part of 0 .. parts - 1, each on a thread of its own, and returns
  // when all are done. What part 0 throws is passed on; the other parts must not throw.
  template <class Work>
  void Run(int parts, const Work& work) {
    RunErased(
        parts, [](const void* context, int part) { (*static_cast<const Work*>(context))(part); },
        &work);
  }

 private:
  using Function = void (*)(const void* context, int part);

  void RunErased(int parts, Function function, const void* context) VS_EXCLUDES(mutex_);
  void Help(int part) VS_EXCLUDES(mutex_);

  Mutex mutex_;
  CondVar changed_;
  uint64_t round_ VS_GUARDED_BY(mutex_) = 0;
  int parts_ VS_GUARDED_BY(mutex_) = 0;
  int unfinished_ VS_GUARDED_BY(mutex_) = 0;
  Function function_ VS_GUARDED_BY(mutex_) = nullptr;
  const void* context_ VS_GUARDED_BY(mutex_) = nullptr;
  bool ending_ VS_GUARDED_BY(mutex_) = false;
  std::vector<std::thread> helpers_;  // helper h runs part h + 1
};

}  // namespace vs
