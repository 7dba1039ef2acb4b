#pragma once

#include <memory>

#include "engine/base/clock.h"
#include "engine/base/status.h"
#include "engine/core/environment.h"
#include "engine/core/run.h"
#include "engine/core/sequence.h"

namespace vs {

// Runs any number of sequences on a fixed number of worker threads.
//
// A task is (frame, block). It is ready when all blocks that feed it are done with this frame and
// the block itself is done with the frame before: so a block never runs twice at once, sees frames
// in order, and independent branches run in parallel. The sources of a sequence run first, one
// after the other. Ready tasks run by sequence priority, then nearer the output, then older frame.
// A new frame enters, when no such task is left to do, once every source is Ready() and fewer than
// max_frames_in_flight are inside; sequences of equal priority take turns. What a source has to
// throw away meanwhile it counts.
//
// An error of a block's Run() makes the blocks behind it skip this frame. An exception ends its run
// (RunState::kFault, blocks stopped); other runs go on. In a warm sequence the scheduler allocates
// nothing. Where the process may (CAP_SYS_NICE), workers run at a niceness of 5 below its own.
class Scheduler {
 public:
  // At least one worker. The clock must outlive the scheduler.
  Scheduler(int workers, const Clock& clock);
  ~Scheduler();  // stops all runs
  Scheduler(const Scheduler&) = delete;
  Scheduler& operator=(const Scheduler&) = delete;

  // Starts the blocks (those nearest the output first, sources last) and lets frames in.
  // `environment` is copied. An error of a block's Start() comes back with the block's id; every
  // block is stopped again then. Thread-safe.
  Result<std::shared_ptr<Run>> Start(std::unique_ptr<Sequence> sequence,
                                     const Environment& environment);

  int workers() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vs
