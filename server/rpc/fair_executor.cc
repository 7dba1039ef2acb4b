#include "server/rpc/fair_executor.h"

#include <limits>
#include <utility>

#include "engine/base/str.h"

namespace vs {

FairExecutor::FairExecutor(const FairExecutorOptions& options)
    : options_(options), turns_(options.threads, std::numeric_limits<size_t>::max()) {}

FairExecutor::~FairExecutor() { Stop(); }

Status FairExecutor::Post(const std::string& who, std::function<void()> task) {
  MutexLock lock(mutex_);
  if (stopping_) return Unavailable("the server is shutting down");
  if (waiting_count_ >= options_.max_waiting) {
    return ResourceExhausted(Str("the server has ", waiting_count_,
                                 " calls of this kind waiting, its limit; try again shortly"))
        .WithReason("OVERLOADED");
  }
  const auto [own, is_new] = waiting_.try_emplace(who);
  if (own->second.size() >= options_.max_waiting_each) {
    return ResourceExhausted(Str("this login has ", own->second.size(),
                                 " calls of this kind waiting, its limit; await their answers"))
        .WithReason("OVERLOADED");
  }
  own->second.push_back(std::move(task));
  ++waiting_count_;
  if (is_new) turns_.Post([this, who] { RunNextOf(who); });
  return Status();
}

void FairExecutor::Stop() {
  {
    MutexLock lock(mutex_);
    stopping_ = true;
  }
  turns_.Stop();
}

void FairExecutor::RunNextOf(const std::string& who) {
  bool again = true;
  while (again) {
    std::function<void()> task;
    {
      MutexLock lock(mutex_);
      std::deque<std::function<void()>>& own = waiting_.at(who);
      task = std::move(own.front());
      own.pop_front();
      --waiting_count_;
    }
    task();
    task = nullptr;  // what it holds goes before the next one may begin
    {
      MutexLock lock(mutex_);
      const auto own = waiting_.find(who);
      if (own->second.empty()) {
        waiting_.erase(own);
        return;
      }
    }
    // Behind the others; there is no behind any more when all of them are stopping.
    again = !turns_.Post([this, who] { RunNextOf(who); });
  }
}

}  // namespace vs
