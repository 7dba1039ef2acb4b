#pragma once

#include <algorithm>
#include <chrono>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "engine/base/mutex.h"
#include "engine/base/status.h"

namespace vs {

// Runs the calls of other threads on the one thread that owns a device. A caller waits for a
// bounded time, whatever the device does: 1 s, or 3 s while the device is being opened. At most 16
// calls wait at once.
//
// A call is a step that the device's thread repeats, between its other duties, until it gives a
// result, so that a long one (reading all features) does not keep pictures waiting. A caller that
// gave up leaves its step behind, so it must own whatever it uses.
template <class Device>
class DeviceCalls {
 public:
  template <class T>
  using Step = std::function<std::optional<Result<T>>(Device&)>;

  // For any thread. UNAVAILABLE when the device cannot answer, RESOURCE_EXHAUSTED when too many
  // calls wait.
  template <class T>
  Result<T> Call(Step<T> step) VS_EXCLUDES(mutex_) {
    auto result = std::make_shared<std::optional<Result<T>>>();
    auto pending = std::make_shared<Pending>();
    pending->step = [result, step = std::move(step)](Device& device) {
      *result = step(device);
      return result->has_value();
    };
    VS_RETURN_IF_ERROR(WaitFor(pending));
    return std::move(**result);
  }

  // The rest is for the device's own thread.

  // Runs waiting calls until none is left or `budget` is spent.
  void Run(Device& device, std::chrono::milliseconds budget) VS_EXCLUDES(mutex_) {
    const auto deadline = SteadyClock::now() + budget;
    while (const std::shared_ptr<Pending> pending = TakeNext()) {
      const bool done = pending->step(device);
      MutexLock lock(mutex_);
      busy_ = false;
      if (done) {
        pending->done = true;
        done_.NotifyAll();
      } else if (!pending->abandoned) {
        waiting_.push_front(pending);
      }
      if (SteadyClock::now() >= deadline) return;
    }
  }

  // From now on calls wait for the device: while it is being opened, or once it is open.
  void AdmitOpening() { Admit(kOpeningPatience); }
  void AdmitOpen() { Admit(kPatience); }

  // From now on calls fail at once with `reason`, as do those that wait.
  void Refuse(const Status& reason) VS_EXCLUDES(mutex_) {
    MutexLock lock(mutex_);
    refusal_ = reason;
    for (const auto& pending : waiting_) {
      pending->failure = reason;
      pending->done = true;
    }
    waiting_.clear();
    done_.NotifyAll();
  }

  bool Waiting() const VS_EXCLUDES(mutex_) {
    MutexLock lock(mutex_);
    return !waiting_.empty();
  }

  // Sleeps until a call comes, somebody pokes, or `timeout`.
  void Sleep(std::chrono::milliseconds timeout) VS_EXCLUDES(mutex_) {
    MutexLock lock(mutex_);
    if (waiting_.empty() && !poked_) work_.WaitFor(mutex_, timeout);
    poked_ = false;
  }

  // For any thread: ends a Sleep, also one that has not begun yet.
  void Poke() VS_EXCLUDES(mutex_) {
    MutexLock lock(mutex_);
    poked_ = true;
    work_.NotifyAll();
  }

 private:
  using SteadyClock = std::chrono::steady_clock;

  static constexpr size_t kMaxWaiting = 16;
  static constexpr std::chrono::milliseconds kPatience{1000};
  static constexpr std::chrono::milliseconds kOpeningPatience{3000};
  static constexpr std::chrono::milliseconds kLongestStep{300};

  struct Pending {
    std::function<bool(Device&)> step;
    Status failure;
    bool done = false;
    bool abandoned = false;
  };

  Status WaitFor(const std::shared_ptr<Pending>& pending) VS_EXCLUDES(mutex_) {
    MutexLock lock(mutex_);
    if (!refusal_.ok()) return refusal_;
    const auto now = SteadyClock::now();
    if (busy_ && now - busy_since_ > kLongestStep) return NoAnswer();
    if (waiting_.size() >= kMaxWaiting) {
      return ResourceExhausted("too many requests wait for this camera; try again");
    }
    waiting_.push_back(pending);
    work_.NotifyAll();
    const auto deadline = now + patience_;
    while (!pending->done) {
      const auto left = deadline - SteadyClock::now();
      if (left.count() <= 0) {
        pending->abandoned = true;
        std::erase(waiting_, pending);
        return NoAnswer();
      }
      done_.WaitFor(mutex_, left);
    }
    return pending->failure;
  }

  std::shared_ptr<Pending> TakeNext() VS_EXCLUDES(mutex_) {
    MutexLock lock(mutex_);
    if (waiting_.empty()) return nullptr;
    std::shared_ptr<Pending> next = std::move(waiting_.front());
    waiting_.pop_front();
    busy_ = true;
    busy_since_ = SteadyClock::now();
    return next;
  }

  void Admit(std::chrono::milliseconds patience) VS_EXCLUDES(mutex_) {
    MutexLock lock(mutex_);
    refusal_ = Status();
    patience_ = patience;
  }

  static Status NoAnswer() { return Unavailable("the camera does not answer at the moment"); }

  mutable Mutex mutex_;
  CondVar work_;
  CondVar done_;
  std::deque<std::shared_ptr<Pending>> waiting_ VS_GUARDED_BY(mutex_);
  Status refusal_ VS_GUARDED_BY(mutex_);
  std::chrono::milliseconds patience_ VS_GUARDED_BY(mutex_) = kOpeningPatience;
  bool poked_ VS_GUARDED_BY(mutex_) = false;
  bool busy_ VS_GUARDED_BY(mutex_) = false;
  SteadyClock::time_point busy_since_ VS_GUARDED_BY(mutex_);
};

}  // namespace vs
