#include "engine/core/active_run.h"

#include <algorithm>
#include <exception>
#include <utility>

#include "engine/base/log.h"
#include "engine/base/str.h"

namespace vs {
namespace {

std::shared_ptr<const RunInfo> InfoOf(const Sequence& sequence) {
  RunInfo info{sequence.spec().id, sequence.revision(), {}};
  for (const Sequence::Node& node : sequence.nodes()) info.block_ids.push_back(node.id);
  return std::make_shared<const RunInfo>(std::move(info));
}

// The text of whatever `call` throws; empty when it does not.
template <class Call>
std::string ExceptionOf(const Call& call) {
  try {
    call();
    return "";
  } catch (const std::exception& exception) {
    return Str("exception: ", exception.what());
  } catch (...) {
    return "exception of an unknown type";
  }
}

}  // namespace

ActiveRun::ActiveRun(std::unique_ptr<Sequence> sequence, Environment environment,
                     const Clock& clock, std::shared_ptr<TaskQueue> queue, FaultHandler on_fault)
    : sequence_(std::move(sequence)),
      environment_(std::move(environment)),
      clock_(clock),
      shared_queue_(std::move(queue)),
      queue_(*shared_queue_),
      on_fault_(std::move(on_fault)),
      info_(InfoOf(*sequence_)),
      parameters_(sequence_.get()),
      counters_(sequence_->nodes().size()),
      frames_(sequence_->spec().max_frames_in_flight),
      done_(sequence_->nodes().size(), 0) {
  PlanTasks();
  for (FrameState& state : frames_) {
    state.frame = std::make_unique<FrameInFlight>(*sequence_, info_);
    state.waiting.resize(done_.size());
  }
}

ActiveRun::~ActiveRun() { Stop(); }

// Blocks wait for those that feed them. The sources form a chain and what they feed waits for the
// last of them, so that no block sees a frame whose capture is still being filled in.
void ActiveRun::PlanTasks() {
  const std::vector<Sequence::Node>& nodes = sequence_->nodes();
  const auto sources =
      std::count_if(nodes.begin(), nodes.end(), [](const auto& node) { return node.is_source(); });
  last_source_ = static_cast<int>(sources) - 1;
  followers_.resize(nodes.size());
  waits_for_.resize(nodes.size(), 0);
  const auto wait = [this](int node, int before) {
    followers_[before].push_back(node);
    ++waits_for_[node];
  };
  for (int node = 1; node <= last_source_; ++node) wait(node, node - 1);
  for (int node = last_source_ + 1; node < static_cast<int>(nodes.size()); ++node) {
    const std::vector<int>& upstream = nodes[node].upstream;
    if (upstream.front() <= last_source_) wait(node, last_source_);
    for (const int before : upstream) {
      if (before > last_source_) wait(node, before);
    }
  }
}

Status ActiveRun::Start() {
  if (Status status = StartBlocks(); !status.ok()) {
    StopBlocks();
    MutexLock lock(queue_.mutex);
    phase_ = Phase::kOver;
    return status;
  }
  if (environment_.topics != nullptr) taps_ = Taps(*sequence_, *environment_.topics);
  MutexLock lock(queue_.mutex);
  queue_.Reserve(TaskRoom());
  phase_ = Phase::kOpen;
  TryEntry();
  queue_.Kick();
  return Status();
}

Status ActiveRun::StartBlocks() {
  std::vector<Sequence::Node>& nodes = sequence_->nodes();
  for (Sequence::Node& node : nodes) node.block->Attach(&environment_, info_, [this] { Wake(); });
  for (auto node = nodes.rbegin(); node != nodes.rend(); ++node) {
    Status status;
    const std::string exception = ExceptionOf([&] { status = node->block->Start(); });
    if (!exception.empty()) status = Internal(exception);
    if (!status.ok()) return status.Annotated(node->id);
  }
  return Status();
}

void ActiveRun::StopBlocks() {
  taps_ = Taps();
  for (Sequence::Node& node : sequence_->nodes()) {
    const std::string exception = ExceptionOf([&] { node.block->Stop(); });
    if (!exception.empty()) {
      LogError("sequence", Str(info_->sequence, "/", node.id, " failed to stop: ", exception));
    }
  }
}

void ActiveRun::Stop() {
  {
    MutexLock lock(queue_.mutex);
    if (phase_ == Phase::kOpen) phase_ = Phase::kEnding;
    while (tasks_ > 0) changed_.Wait(queue_.mutex);
    while (phase_ == Phase::kStoppingBlocks) changed_.Wait(queue_.mutex);
    if (phase_ != Phase::kEnding) return;
    phase_ = Phase::kStoppingBlocks;
    // After a fault frames are left behind.
    for (FrameState& state : frames_) state.frame->Clear();
    in_flight_ = 0;
  }
  StopBlocks();
  MutexLock lock(queue_.mutex);
  queue_.Unreserve(TaskRoom());
  phase_ = Phase::kOver;
  changed_.NotifyAll();
}

void ActiveRun::Wake() {
  MutexLock lock(queue_.mutex);
  ask_sources_ = true;
  TryEntry();
  queue_.Kick();
}

void ActiveRun::Execute(const Task& task) {
  if (task.node == Task::kEntry) {
    ExecuteEntry();
    return;
  }
  BlockOutcome outcome = ExecuteBlock(task);
  MutexLock lock(queue_.mutex);
  if (!fault_) {
    FrameState& state = StateOf(task.frame->context.number);
    Count(task.node, outcome, &state);
    if (outcome.kind == BlockOutcome::Kind::kException) {
      Fail();
    } else {
      Advance(task.node, &state);
    }
  }
  TaskDone();
}

BlockOutcome ActiveRun::ExecuteBlock(const Task& task) {
  const std::string exception =
      ExceptionOf([&] { parameters_.Apply(task.node, task.frame->context.number); });
  if (!exception.empty()) return {BlockOutcome::Kind::kException, Internal(exception)};
  return RunBlock(sequence_->nodes()[task.node], task.node, clock_, taps_, task.frame);
}

void ActiveRun::ExecuteEntry() {
  bool ready = true;
  int asked = 0;
  const std::string exception = ExceptionOf([&] {
    while (ready && asked <= last_source_) {
      ready = sequence_->nodes()[asked].block->Ready();
      ++asked;
    }
  });
  MutexLock lock(queue_.mutex);
  entry_pushed_ = false;
  if (fault_) {
    // A block threw meanwhile: the run is over, and why is known.
  } else if (!exception.empty()) {
    last_error_ = Str(info_->block_ids[asked], ": ", exception);
    Fail();
  } else if (ready && phase_ == Phase::kOpen) {
    BeginFrame();
  } else {
    TryEntry();  // a source may have called while it was asked
  }
  TaskDone();
}

void ActiveRun::TryEntry() {
  if (phase_ != Phase::kOpen || entry_pushed_ || !ask_sources_ ||
      in_flight_ == static_cast<int>(frames_.size()) || done_[last_source_] + 1 != next_number_) {
    return;
  }
  entry_pushed_ = true;
  ask_sources_ = false;
  Task task;
  task.run = this;
  task.priority = sequence_->spec().priority;
  task.age = last_entry_age_;
  queue_.Push(task);
  ++tasks_;
}

void ActiveRun::BeginFrame() {
  ask_sources_ = true;  // there may be more where this one comes from
  last_entry_age_ = queue_.NextAge();
  const uint64_t number = next_number_++;
  FrameState& state = StateOf(number);
  state.left = static_cast<int>(done_.size());
  state.failed = false;
  state.age = last_entry_age_;
  state.frame->Begin(*sequence_, number);
  state.frame->context.popped_ns = clock_.MonotonicNs();
  parameters_.Stamp(&state.frame->context);
  ++in_flight_;
  for (size_t node = 0; node < done_.size(); ++node) {
    state.waiting[node] = waits_for_[node] + (done_[node] + 1 == number ? 0 : 1);
  }
  Push(0, &state);
}

void ActiveRun::Push(int node, FrameState* state) {
  queue_.Push({this, node, state->frame.get(), sequence_->spec().priority,
               sequence_->nodes()[node].distance_to_output, state->age});
  ++tasks_;
}

void ActiveRun::Count(int node, const BlockOutcome& outcome, FrameState* state) {
  Counters& counters = counters_[node];
  if (outcome.kind == BlockOutcome::Kind::kSkipped) {
    counters.skipped.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  counters.runs.fetch_add(1, std::memory_order_relaxed);
  counters.durations.Add(outcome.duration_ns);
  counters.failing = outcome.kind != BlockOutcome::Kind::kGood;
  if (!counters.failing) return;
  counters.last_failure = outcome.status.message();
  counters.errors.fetch_add(1, std::memory_order_relaxed);
  last_error_ = Str(info_->block_ids[node], ": ", outcome.status.message());
  state->failed = true;
}

void ActiveRun::Advance(int node, FrameState* state) {
  const uint64_t number = state->frame->context.number;
  done_[node] = number;
  for (const int follower : followers_[node]) {
    if (--state->waiting[follower] == 0) Push(follower, state);
  }
  if (number + 1 < next_number_) {
    FrameState& next = StateOf(number + 1);
    if (--next.waiting[node] == 0) Push(node, &next);
  }
  if (--state->left == 0) EndFrame(*state);
  TryEntry();
}

void ActiveRun::EndFrame(const FrameState& state) {
  const FrameContext& frame = state.frame->context;
  const int64_t now_ns = clock_.MonotonicNs();
  const int64_t latency_ns = now_ns - (frame.capture_ns != 0 ? frame.capture_ns : frame.popped_ns);
  const double budget_ms = sequence_->spec().latency_budget_ms;
  if (budget_ms != 0 && static_cast<double>(latency_ns) > budget_ms * 1e6) ++frames_over_budget_;
  latencies_.Add(latency_ns);
  completions_.Add(now_ns);
  --in_flight_;
  ++frames_done_;
  if (state.failed) {
    ++frames_failed_;
  } else {
    last_error_.clear();
  }
}

void ActiveRun::Fail() {
  fault_ = true;
  phase_ = Phase::kEnding;
  tasks_ -= queue_.Remove(this);
  on_fault_(weak_from_this());
}

// The last access of a worker to this run: it may be gone as soon as the lock is.
void ActiveRun::TaskDone() {
  if (--tasks_ == 0) changed_.NotifyAll();
}

Result<uint64_t> ActiveRun::SetParameters(const std::vector<ParamAssignment>& batch) {
  MutexLock one_after_the_other(editing_);
  VS_RETURN_IF_ERROR(parameters_.Check(batch));
  MutexLock lock(queue_.mutex);
  if (phase_ != Phase::kOpen) {
    return FailedPrecondition(Str("sequence ", info_->sequence, " is not running any more"));
  }
  parameters_.Change(batch, next_number_);
  return next_number_;
}

RunStats ActiveRun::Stats() const {
  RunStats stats;
  stats.blocks.resize(counters_.size());
  {
    MutexLock lock(queue_.mutex);
    const bool over = phase_ == Phase::kStarting || phase_ == Phase::kOver;
    stats.state = fault_ ? RunState::kFault : over ? RunState::kStopped : RunState::kRunning;
    stats.last_error = last_error_;
    stats.frames = frames_done_;
    stats.failed_frames = frames_failed_;
    stats.frames_in_flight = in_flight_;
    stats.over_budget = frames_over_budget_;
    for (size_t i = 0; i < counters_.size(); ++i) {
      stats.blocks[i].last_failure = counters_[i].last_failure;
      if (counters_[i].failing) stats.blocks[i].last_error = counters_[i].last_failure;
    }
  }
  for (size_t i = 0; i < counters_.size(); ++i) {
    const Counters& counters = counters_[i];
    const std::vector<int64_t> durations = counters.durations.All();
    BlockStats& block = stats.blocks[i];
    block.id = info_->block_ids[i];
    block.runs = counters.runs.load(std::memory_order_relaxed);
    block.skipped = counters.skipped.load(std::memory_order_relaxed);
    block.errors = counters.errors.load(std::memory_order_relaxed);
    block.last_ns = durations.empty() ? 0 : durations.back();
    block.p50_ns = Percentile(durations, 50);
    block.p99_ns = Percentile(durations, 99);
  }
  AskSources(&stats);
  stats.frames_per_second = RatePerSecond(completions_.All(), clock_.MonotonicNs());
  stats.latency_p50_ns = Percentile(latencies_.All(), 50);
  stats.latency_p99_ns = Percentile(latencies_.All(), 99);
  stats.latency_budget_ms = sequence_->spec().latency_budget_ms;
  stats.parameter_revision = parameters_.Revision();
  return stats;
}

void ActiveRun::AskSources(RunStats* stats) const {
  for (int i = 0; i <= last_source_; ++i) {
    const Block& source = *sequence_->nodes()[i].block;
    stats->dropped += source.Dropped();
    SourceReport report = source.Report();
    BlockStats& block = stats->blocks[i];
    block.readings = std::move(report.readings);
    if (report.problem.empty()) continue;
    if (stats->last_error.empty()) stats->last_error = Str(block.id, ": ", report.problem);
    if (block.last_error.empty()) block.last_error = std::move(report.problem);
  }
}

std::string_view RunStateName(RunState state) {
  switch (state) {
    case RunState::kStopped:
      return "stopped";
    case RunState::kRunning:
      return "running";
    case RunState::kFault:
      break;
  }
  return "fault";
}

}  // namespace vs
