#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/clock.h"
#include "engine/base/mutex.h"
#include "engine/core/environment.h"
#include "engine/core/graph.h"
#include "engine/core/live_parameters.h"
#include "engine/core/recent_times.h"
#include "engine/core/run.h"
#include "engine/core/runner.h"
#include "engine/core/sequence.h"
#include "engine/core/taps.h"
#include "engine/core/task_queue.h"

namespace vs {

// A sequence on a task queue: decides which frame and block can go on, and carries out the tasks
// that workers take for it. See scheduler.h for the rules.
//
// A frame enters when the sources are idle and ready. Sources are asked without a lock, by a worker
// that took an entry task. A run is over when it is told to end, or is in fault, and has no task
// left, queued or under way.
class ActiveRun final : public Run, public std::enable_shared_from_this<ActiveRun> {
 public:
  using FaultHandler = std::function<void(std::weak_ptr<ActiveRun>)>;

  // `on_fault` is called once, on a worker and with the queue locked, when a block threw; somebody
  // must then call Stop(), on another thread.
  ActiveRun(std::unique_ptr<Sequence> sequence, Environment environment, const Clock& clock,
            std::shared_ptr<TaskQueue> queue, FaultHandler on_fault);
  ~ActiveRun() override;

  // Starts the blocks and lets frames in; on an error stops them again. Once.
  Status Start();
  // Carries out a task of this run, on a worker.
  void Execute(const Task& task);

  const Sequence& sequence() const override { return *sequence_; }
  RunStats Stats() const override;
  void Stop() override;
  std::vector<ParamAssignment> Parameters() const override { return parameters_.Values(); }
  Result<uint64_t> SetParameters(const std::vector<ParamAssignment>& batch) override;

 private:
  enum class Phase { kStarting, kOpen, kEnding, kStoppingBlocks, kOver };

  struct Counters {
    std::atomic<uint64_t> runs = 0;
    std::atomic<uint64_t> skipped = 0;
    std::atomic<uint64_t> errors = 0;
    RecentTimes durations;
    bool failing = false;      // the last run failed; guarded by queue_.mutex
    std::string last_failure;  // guarded by queue_.mutex
  };
  struct FrameState {
    std::unique_ptr<FrameInFlight> frame;
    std::vector<int> waiting;  // for each node: what must be done before it can run
    int left = 0;              // nodes
    bool failed = false;
    uint64_t age = 0;
  };

  void PlanTasks();
  size_t TaskRoom() const { return counters_.size() + 1; }  // each block once, and an entry
  Status StartBlocks();
  void StopBlocks();
  // What the sources say of themselves; a failed run has the first word.
  void AskSources(RunStats* stats) const;
  void Wake();

  void ExecuteEntry();
  BlockOutcome ExecuteBlock(const Task& task);

  void TryEntry() VS_REQUIRES(queue_.mutex);
  void BeginFrame() VS_REQUIRES(queue_.mutex);
  void Push(int node, FrameState* state) VS_REQUIRES(queue_.mutex);
  void Count(int node, const BlockOutcome& outcome, FrameState* state) VS_REQUIRES(queue_.mutex);
  void Advance(int node, FrameState* state) VS_REQUIRES(queue_.mutex);
  void EndFrame(const FrameState& state) VS_REQUIRES(queue_.mutex);
  void Fail() VS_REQUIRES(queue_.mutex);
  void TaskDone() VS_REQUIRES(queue_.mutex);
  FrameState& StateOf(uint64_t number) VS_REQUIRES(queue_.mutex) {
    return frames_[number % frames_.size()];
  }

  const std::unique_ptr<Sequence> sequence_;
  const Environment environment_;
  const Clock& clock_;
  const std::shared_ptr<TaskQueue> shared_queue_;
  TaskQueue& queue_;
  const FaultHandler on_fault_;
  const std::shared_ptr<const RunInfo> info_;
  LiveParameters parameters_;
  Taps taps_;  // changes only while no task is under way

  Graph followers_;             // for each node: those that wait for it
  std::vector<int> waits_for_;  // for each node: how many it waits for
  int last_source_ = 0;

  std::vector<Counters> counters_;
  RecentTimes latencies_;
  RecentTimes completions_;

  Mutex editing_;    // held while a batch is checked and changed, before queue_.mutex
  CondVar changed_;  // of phase_ or tasks_
  Phase phase_ VS_GUARDED_BY(queue_.mutex) = Phase::kStarting;
  bool fault_ VS_GUARDED_BY(queue_.mutex) = false;
  int tasks_ VS_GUARDED_BY(queue_.mutex) = 0;  // queued or under way
  bool entry_pushed_ VS_GUARDED_BY(queue_.mutex) = false;
  bool ask_sources_ VS_GUARDED_BY(queue_.mutex) = true;  // they may have become ready
  uint64_t last_entry_age_ VS_GUARDED_BY(queue_.mutex) = 0;
  uint64_t next_number_ VS_GUARDED_BY(queue_.mutex) = 1;
  int in_flight_ VS_GUARDED_BY(queue_.mutex) = 0;
  std::vector<FrameState> frames_ VS_GUARDED_BY(queue_.mutex);
  std::vector<uint64_t> done_ VS_GUARDED_BY(queue_.mutex);  // for each node: its last frame
  uint64_t frames_done_ VS_GUARDED_BY(queue_.mutex) = 0;
  uint64_t frames_failed_ VS_GUARDED_BY(queue_.mutex) = 0;
  uint64_t frames_over_budget_ VS_GUARDED_BY(queue_.mutex) = 0;
  std::string last_error_ VS_GUARDED_BY(queue_.mutex);
};

}  // namespace vs
