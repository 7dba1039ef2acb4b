#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/clock.h"
#include "engine/base/status.h"
#include "engine/core/environment.h"
#include "engine/core/sequence.h"

namespace vs {

enum class RunState {
  kStopped,
  kRunning,
  kFault,  // ended by an exception in a block, or a block failed to start
};
std::string_view RunStateName(RunState state);

struct BlockStats {
  std::string id;
  uint64_t runs = 0;
  uint64_t skipped = 0;  // frames in which a required input had no value
  uint64_t errors = 0;
  std::string last_error;  // empty when the last run was good
  int64_t last_ns = 0;     // duration of the last run
  int64_t p50_ns = 0;      // over the last 256 runs
  int64_t p99_ns = 0;
};

struct RunStats {
  RunState state = RunState::kStopped;
  std::string last_error;      // "match: ..." with the block's path; empty when all is well
  uint64_t frames = 0;         // completed
  uint64_t failed_frames = 0;  // of these, with an error in some block
  uint64_t dropped = 0;        // never entered, the sequence was busy (sum of the sources)
  int frames_in_flight = 0;
  double frames_per_second = 0;  // completed, over the last second or so
  int64_t latency_p50_ns = 0;    // capture (or pop) to the end of the last block
  int64_t latency_p99_ns = 0;
  uint64_t parameter_revision = 0;
  std::vector<BlockStats> blocks;  // in topological order
};

// One run of one sequence, from start to stop. Thread-safe.
class Run {
 public:
  virtual ~Run() = default;

  virtual const Sequence& sequence() const = 0;
  virtual RunStats Stats() const = 0;
  // Ends the run: no new frames, those in flight complete, then every block's Stop() is called.
  // Returns when nothing of the run is active any more. Idempotent.
  virtual void Stop() = 0;

  // The values in effect (of changes still waiting: the new ones), block by block.
  virtual std::vector<ParamAssignment> Parameters() const = 0;
  // All or nothing: each assignment is checked first, all faults are reported at once. The batch
  // lands between two frames: every block sees it from the same frame on. Gives the number of that
  // frame (the next one to enter). FAILED_PRECONDITION for a parameter that is not live.
  virtual Result<uint64_t> SetParameters(const std::vector<ParamAssignment>& batch) = 0;
};

// Runs any number of sequences on a fixed number of worker threads.
//
// A task is (frame, block). It is ready when all blocks that feed it are done with this frame and
// the block itself is done with the frame before: so a block never runs twice at once, sees frames
// in order, and independent branches run in parallel. Ready tasks run by sequence priority, then
// nearer the output, then older frame. A new frame enters when every source is Ready() and fewer
// than max_frames_in_flight are inside; what a source has to throw away meanwhile it counts.
// In a warm sequence the scheduler allocates nothing.
class Scheduler {
 public:
  // At least one worker. The clock must outlive the scheduler.
  Scheduler(int workers, const Clock& clock);
  ~Scheduler();  // stops all runs
  Scheduler(const Scheduler&) = delete;
  Scheduler& operator=(const Scheduler&) = delete;

  // Starts the blocks (sources last) and lets frames in. `environment` is copied. An error of a
  // block's Start() comes back with the block's id, everything already started is stopped again.
  Result<std::shared_ptr<Run>> Start(std::unique_ptr<Sequence> sequence,
                                     const Environment& environment);

  int workers() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vs
