#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/source_report.h"
#include "engine/base/status.h"
#include "engine/core/sequence.h"

namespace vs {

enum class RunState {
  kStopped,
  kRunning,
  kFault,  // ended by an exception in a block
};
// "stopped", "running", "fault".
std::string_view RunStateName(RunState state);

struct BlockStats {
  std::string id;
  uint64_t runs = 0;
  uint64_t skipped = 0;      // frames in which a required input had no value
  uint64_t errors = 0;       // of the runs
  std::string last_error;    // empty when the last run was good and, of a source, all is well
  std::string last_failure;  // of the last run that failed, also when later ones were good
  int64_t last_ns = 0;       // duration of the last run
  int64_t p50_ns = 0;        // over the last 256 runs
  int64_t p99_ns = 0;
  std::vector<Reading> readings;  // of a source: see SourceReport
};

struct RunStats {
  RunState state = RunState::kStopped;
  // "match: ..." with the block's id; empty when the last frame was good and all sources are well.
  std::string last_error;
  uint64_t frames = 0;         // completed
  uint64_t failed_frames = 0;  // of these, with an error in some block
  uint64_t dropped = 0;        // never entered, the sequence was busy (sum of the sources)
  int frames_in_flight = 0;
  double frames_per_second = 0;  // completed, over the last two seconds
  int64_t latency_p50_ns = 0;    // capture (or entry) to the end of the last block,
  int64_t latency_p99_ns = 0;    // over the last 256 frames
  double latency_budget_ms = 0;  // SequenceSpec's
  uint64_t over_budget = 0;      // frames that took longer
  uint64_t parameter_revision = 0;
  std::vector<BlockStats> blocks;  // in topological order
};

// One run of one sequence, from start to stop; made by Scheduler::Start. Dropping the last handle
// stops it. Thread-safe; may outlive the scheduler, which then has stopped it.
class Run {
 public:
  virtual ~Run() = default;

  virtual const Sequence& sequence() const = 0;
  virtual RunStats Stats() const = 0;
  // Ends the run: no new frames, those in flight complete, then every block's Stop() is called,
  // sources first. Returns when nothing of the run is active any more. Idempotent; a run in fault
  // stays in fault. Not from within a block or a topic's listener.
  virtual void Stop() = 0;

  // The values in effect for the next frame to enter, block by block.
  virtual std::vector<ParamAssignment> Parameters() const = 0;
  // All or nothing: each assignment is checked first, all faults are reported at once. The batch
  // lands between two frames: every block sees it from the same frame on. Gives the number of that
  // frame (the next one to enter). FAILED_PRECONDITION for a parameter that is not live, or when
  // the run has ended.
  virtual Result<uint64_t> SetParameters(const std::vector<ParamAssignment>& batch) = 0;
};

}  // namespace vs
