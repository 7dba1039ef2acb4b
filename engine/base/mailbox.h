#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <utility>

#include "engine/base/mutex.h"

namespace vs {

// Hands values from a producing thread to a consumer that may be slower.
//
// kLatest: holds one value; a newer one replaces it and the loss is counted. For live cameras.
// kEvery: `Put` waits until there is room. For recorded images, where each one must be processed.
template <class T>
class Mailbox {
 public:
  enum class Policy { kLatest, kEvery };

  explicit Mailbox(Policy policy = Policy::kLatest) : policy_(policy) {}

  // Empties a mailbox, closed or not, for another use. Not while a Put may wait.
  void Reopen(Policy policy) VS_EXCLUDES(mutex_) {
    MutexLock lock(mutex_);
    policy_ = policy;
    value_.reset();
    dropped_ = 0;
    closed_ = false;
  }

  // Called, without a lock held, whenever a value has become available. Set before the first Put.
  void OnAvailable(std::function<void()> notify) { notify_ = std::move(notify); }

  // False when the mailbox is closed; the value is then gone.
  bool Put(T value) VS_EXCLUDES(mutex_) {
    {
      MutexLock lock(mutex_);
      if (policy_ == Policy::kEvery) {
        while (value_ && !closed_) room_.Wait(mutex_);
      }
      if (closed_) return false;
      if (value_) ++dropped_;
      value_ = std::move(value);
    }
    if (notify_) notify_();
    return true;
  }

  std::optional<T> TryTake() VS_EXCLUDES(mutex_) {
    MutexLock lock(mutex_);
    std::optional<T> taken = std::exchange(value_, std::nullopt);
    if (taken) room_.NotifyOne();
    return taken;
  }

  bool Available() const VS_EXCLUDES(mutex_) {
    MutexLock lock(mutex_);
    return value_.has_value();
  }

  // Wakes a waiting Put; later values are refused. A value already inside can still be taken.
  void Close() VS_EXCLUDES(mutex_) {
    MutexLock lock(mutex_);
    closed_ = true;
    room_.NotifyAll();
  }

  // Values that were replaced before anybody took them.
  uint64_t Dropped() const VS_EXCLUDES(mutex_) {
    MutexLock lock(mutex_);
    return dropped_;
  }

 private:
  std::function<void()> notify_;
  mutable Mutex mutex_;
  CondVar room_;
  Policy policy_ VS_GUARDED_BY(mutex_);
  std::optional<T> value_ VS_GUARDED_BY(mutex_);
  uint64_t dropped_ VS_GUARDED_BY(mutex_) = 0;
  bool closed_ VS_GUARDED_BY(mutex_) = false;
};

}  // namespace vs
