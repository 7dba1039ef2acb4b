#include "engine/stereo/thread_team.h"

namespace vs {

ThreadTeam::~ThreadTeam() {
  {
    MutexLock lock(mutex_);
    ending_ = true;
    changed_.NotifyAll();
  }
  for (std::thread& helper : helpers_) helper.join();
}

void ThreadTeam::RunErased(int parts, Function function, const void* context) {
  if (parts <= 1) return function(context, 0);
  while (static_cast<int>(helpers_.size()) < parts - 1) {
    const int part = static_cast<int>(helpers_.size()) + 1;
    helpers_.emplace_back([this, part] { Help(part); });
  }
  {
    MutexLock lock(mutex_);
    ++round_;
    parts_ = parts;
    unfinished_ = parts - 1;
    function_ = function;
    context_ = context;
    changed_.NotifyAll();
  }
  // Helpers work on the caller's data: they must be done before anything leaves this frame.
  struct Join {
    ThreadTeam* team;
    ~Join() {
      MutexLock lock(team->mutex_);
      while (team->unfinished_ > 0) team->changed_.Wait(team->mutex_);
    }
  } join{this};
  function(context, 0);
}

void ThreadTeam::Help(int part) {
  uint64_t seen = 0;
  for (;;) {
    Function function = nullptr;
    const void* context = nullptr;
    {
      MutexLock lock(mutex_);
      while (!ending_ && (round_ == seen || part >= parts_)) {
        seen = round_;
        changed_.Wait(mutex_);
      }
      if (ending_) return;
      seen = round_;
      function = function_;
      context = context_;
    }
    function(context, part);
    MutexLock lock(mutex_);
    --unfinished_;
    changed_.NotifyAll();
  }
}

}  // namespace vs
