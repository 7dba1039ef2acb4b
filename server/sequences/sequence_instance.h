#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "engine/base/clock.h"
#include "engine/base/mutex.h"
#include "engine/base/status.h"
#include "engine/core/environment.h"
#include "engine/core/scheduler.h"
#include "server/sequences/stored_sequence.h"

namespace vs {

enum class Activity {
  kStopped,
  kStarting,
  kRunning,
  kDegraded,  // runs, but a block fails or a camera gives no pictures
  kStopping,
  kFault,  // ended by an exception in a block
};

// What a sequence is doing.
struct SequenceStatus {
  std::string id;
  Activity activity = Activity::kStopped;
  uint64_t revision = 0;    // that runs; 0 = none
  int64_t started_ns = 0;   // UTC; 0 = does not run
  RunStats stats;           // of the running instance, or of one in fault
  std::string error_block;  // empty = no block is to blame
  std::string error;        // what went wrong last, empty = all is well
  int64_t error_ns = 0;     // UTC, when it was first seen in this form

  bool active() const { return activity != Activity::kStopped && activity != Activity::kFault; }
};

// The running instance, if any, of one sequence. Thread-safe; Start and Stop wait for blocks.
class SequenceInstance {
 public:
  // Everything must outlive it.
  SequenceInstance(std::string id, Scheduler& scheduler, const Environment& environment);
  // Stops it.
  ~SequenceInstance();

  // Does nothing while it runs already. `load` gives what to start, once this instance is known to
  // be starting.
  Status Start(const std::function<Result<StoredSequence>()>& load) VS_EXCLUDES(operation_, mutex_);
  void Stop() VS_EXCLUDES(operation_, mutex_);
  // Runs `action` while nobody can start this sequence. FAILED_PRECONDITION while it runs.
  Status WhileStopped(const std::function<Status()>& action) VS_EXCLUDES(operation_, mutex_);

  SequenceStatus Snapshot() VS_EXCLUDES(mutex_);
  // Null when it does not run.
  std::shared_ptr<Run> run() const VS_EXCLUDES(mutex_);

 private:
  Status Launch(const StoredSequence& stored) VS_EXCLUDES(mutex_);
  void SetTransition(Activity activity) VS_EXCLUDES(mutex_);
  void NoteError(const std::string& error) VS_REQUIRES(mutex_);

  const std::string id_;
  Scheduler& scheduler_;
  const Environment& environment_;
  Mutex operation_;  // held while it starts or stops, before mutex_
  mutable Mutex mutex_;
  Activity transition_ VS_GUARDED_BY(mutex_) = Activity::kStopped;  // kStopped = none
  std::shared_ptr<Run> run_ VS_GUARDED_BY(mutex_);
  int64_t started_ns_ VS_GUARDED_BY(mutex_) = 0;
  std::string error_ VS_GUARDED_BY(mutex_);  // "block: message"
  int64_t error_ns_ VS_GUARDED_BY(mutex_) = 0;
};

}  // namespace vs
