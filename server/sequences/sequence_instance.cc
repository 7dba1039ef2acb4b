#include "server/sequences/sequence_instance.h"

#include <utility>

#include "engine/base/str.h"

namespace vs {
namespace {

bool Runs(const std::shared_ptr<Run>& run) {
  return run != nullptr && run->Stats().state == RunState::kRunning;
}

}  // namespace

SequenceInstance::SequenceInstance(std::string id, Scheduler& scheduler,
                                   const Environment& environment)
    : id_(std::move(id)), scheduler_(scheduler), environment_(environment) {}

SequenceInstance::~SequenceInstance() { Stop(); }

Status SequenceInstance::Start(const std::function<Result<StoredSequence>()>& load) {
  MutexLock operation(operation_);
  if (Runs(run())) return Status();
  SetTransition(Activity::kStarting);
  const Result<StoredSequence> stored = load();
  Status started = stored.has_value() ? Launch(*stored) : stored.error();
  SetTransition(Activity::kStopped);
  return started;
}

Status SequenceInstance::Launch(const StoredSequence& stored) {
  VS_ASSIGN_OR_RETURN(std::unique_ptr<Sequence> sequence,
                      Sequence::Load(stored.spec, stored.revision));
  std::shared_ptr<Run> ended;  // dropped without the lock: that may take its time
  {
    MutexLock lock(mutex_);
    ended = std::exchange(run_, nullptr);
    error_.clear();
  }
  ended.reset();
  Result<std::shared_ptr<Run>> run = scheduler_.Start(std::move(sequence), environment_);
  MutexLock lock(mutex_);
  if (!run.has_value()) {
    NoteError(run.error().message());
    return run.error();
  }
  run_ = std::move(*run);
  started_ns_ = environment_.clock->UtcNs();
  return Status();
}

void SequenceInstance::Stop() {
  MutexLock operation(operation_);
  const std::shared_ptr<Run> running = run();
  if (running == nullptr) return;
  SetTransition(Activity::kStopping);
  running->Stop();
  MutexLock lock(mutex_);
  run_ = nullptr;
  error_.clear();
  transition_ = Activity::kStopped;
}

Status SequenceInstance::WhileStopped(const std::function<Status()>& action) {
  MutexLock operation(operation_);
  if (Runs(run())) return FailedPrecondition(Str("sequence ", id_, " is running: stop it first"));
  return action();
}

SequenceStatus SequenceInstance::Snapshot() {
  SequenceStatus status;
  status.id = id_;
  const std::shared_ptr<Run> run_now = run();
  if (run_now != nullptr) {
    status.stats = run_now->Stats();
    status.revision = run_now->sequence().revision();
  }
  MutexLock lock(mutex_);
  if (run_now != nullptr) {
    NoteError(status.stats.last_error);
    const bool good = status.stats.last_error.empty();
    status.activity = status.stats.state != RunState::kRunning ? Activity::kFault
                      : good                                   ? Activity::kRunning
                                                               : Activity::kDegraded;
    status.started_ns = started_ns_;
  }
  if (transition_ != Activity::kStopped) status.activity = transition_;
  status.error = error_;
  status.error_ns = error_ns_;
  // The engine puts the block in front: "match: too little memory".
  const size_t colon = error_.find(": ");
  if (colon != std::string::npos && IsSequenceId(error_.substr(0, colon))) {
    status.error_block = error_.substr(0, colon);
    status.error = error_.substr(colon + 2);
  }
  return status;
}

std::shared_ptr<Run> SequenceInstance::run() const {
  MutexLock lock(mutex_);
  return run_;
}

void SequenceInstance::SetTransition(Activity activity) {
  MutexLock lock(mutex_);
  transition_ = activity;
}

void SequenceInstance::NoteError(const std::string& error) {
  if (error == error_) return;
  error_ = error;
  error_ns_ = environment_.clock->UtcNs();
}

}  // namespace vs
