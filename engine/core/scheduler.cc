#include "engine/core/scheduler.h"

#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <thread>
#include <utility>
#include <vector>

#include "engine/base/log.h"
#include "engine/base/mutex.h"
#include "engine/base/str.h"
#include "engine/core/active_run.h"
#include "engine/core/task_queue.h"

namespace vs {
namespace {

constexpr int kNiceness = -5;

// A page that is open on the same machine must not make frames wait. The calling thread, and what
// it starts, goes before programs that do not ask for more; those still get their turn on a machine
// that is full. Needs CAP_SYS_NICE; without it all goes on as usual.
void GoFirst() {
  const auto thread = static_cast<id_t>(gettid());
  (void)setpriority(PRIO_PROCESS, thread, getpriority(PRIO_PROCESS, thread) + kNiceness);
}

}  // namespace

class Scheduler::Impl {
 public:
  Impl(int workers, const Clock& clock) : clock_(clock) {
    for (int i = 0; i < std::max(workers, 1); ++i) workers_.emplace_back([this] { Work(); });
    cleaner_ = std::thread([this] { CleanUp(); });
  }

  ~Impl() {
    for (const auto& run : Runs()) run->Stop();
    queue_->Close();
    for (std::thread& worker : workers_) worker.join();
    {
      MutexLock lock(mutex_);
      closing_ = true;
      faulted_changed_.NotifyAll();
    }
    cleaner_.join();
  }

  Result<std::shared_ptr<Run>> Start(std::unique_ptr<Sequence> sequence, Environment environment) {
    if (environment.clock == nullptr) environment.clock = &clock_;
    auto run = std::make_shared<ActiveRun>(
        std::move(sequence), std::move(environment), clock_, queue_,
        [this](std::weak_ptr<ActiveRun> faulted) { NoteFault(std::move(faulted)); });
    {
      MutexLock lock(mutex_);
      std::erase_if(runs_, [](const auto& old) { return old.expired(); });
      runs_.push_back(run);
    }
    VS_RETURN_IF_ERROR(run->Start());
    return std::shared_ptr<Run>(std::move(run));
  }

  int workers() const { return static_cast<int>(workers_.size()); }

 private:
  void Work() {
    pthread_setname_np(pthread_self(), "vs-worker");
    GoFirst();
    Task task;
    while (queue_->Take(&task)) task.run->Execute(task);
  }

  void NoteFault(std::weak_ptr<ActiveRun> run) {
    MutexLock lock(mutex_);
    faulted_.push_back(std::move(run));
    faulted_changed_.NotifyAll();
  }

  // Stops the blocks of faulted runs: that may take long (a camera has to answer), so no worker
  // does it.
  void CleanUp() {
    pthread_setname_np(pthread_self(), "vs-cleaner");
    while (true) {
      std::shared_ptr<ActiveRun> run;
      {
        MutexLock lock(mutex_);
        while (faulted_.empty() && !closing_) faulted_changed_.Wait(mutex_);
        if (faulted_.empty()) return;
        run = faulted_.back().lock();
        faulted_.pop_back();
      }
      if (run == nullptr) continue;  // whoever dropped it stops it
      LogError("sequence", Str(run->sequence().spec().id, " ended by ", run->Stats().last_error));
      run->Stop();
    }
  }

  std::vector<std::shared_ptr<ActiveRun>> Runs() {
    MutexLock lock(mutex_);
    std::vector<std::shared_ptr<ActiveRun>> runs;
    for (const auto& weak : runs_) {
      if (auto run = weak.lock()) runs.push_back(std::move(run));
    }
    return runs;
  }

  const Clock& clock_;
  const std::shared_ptr<TaskQueue> queue_ = std::make_shared<TaskQueue>();
  Mutex mutex_;  // taken with the queue's mutex held, never the other way round
  CondVar faulted_changed_;
  std::vector<std::weak_ptr<ActiveRun>> runs_ VS_GUARDED_BY(mutex_);
  std::vector<std::weak_ptr<ActiveRun>> faulted_ VS_GUARDED_BY(mutex_);
  bool closing_ VS_GUARDED_BY(mutex_) = false;
  std::vector<std::thread> workers_;
  std::thread cleaner_;
};

Scheduler::Scheduler(int workers, const Clock& clock)
    : impl_(std::make_unique<Impl>(workers, clock)) {}
Scheduler::~Scheduler() = default;

Result<std::shared_ptr<Run>> Scheduler::Start(std::unique_ptr<Sequence> sequence,
                                              const Environment& environment) {
  return impl_->Start(std::move(sequence), environment);
}

int Scheduler::workers() const { return impl_->workers(); }

}  // namespace vs
