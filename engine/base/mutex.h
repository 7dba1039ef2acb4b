#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>

// Names for clang's thread-safety analysis: which mutex guards which member, checked at compile
// time by the tidy preset. Other compilers see nothing.
#if defined(__clang__)
#define VS_THREAD_ATTRIBUTE(x) __attribute__((x))
#else
#define VS_THREAD_ATTRIBUTE(x)
#endif
#define VS_GUARDED_BY(mutex) VS_THREAD_ATTRIBUTE(guarded_by(mutex))
#define VS_REQUIRES(...) VS_THREAD_ATTRIBUTE(requires_capability(__VA_ARGS__))
#define VS_EXCLUDES(...) VS_THREAD_ATTRIBUTE(locks_excluded(__VA_ARGS__))

namespace vs {

class VS_THREAD_ATTRIBUTE(capability("mutex")) Mutex {
 public:
  void Lock() VS_THREAD_ATTRIBUTE(acquire_capability()) { mutex_.lock(); }
  void Unlock() VS_THREAD_ATTRIBUTE(release_capability()) { mutex_.unlock(); }

 private:
  friend class CondVar;
  std::mutex mutex_;
};

// Holds a Mutex for the length of a scope.
class VS_THREAD_ATTRIBUTE(scoped_lockable) MutexLock {
 public:
  explicit MutexLock(Mutex& mutex) VS_THREAD_ATTRIBUTE(acquire_capability(mutex)) : mutex_(mutex) {
    mutex_.Lock();
  }
  ~MutexLock() VS_THREAD_ATTRIBUTE(release_capability()) { mutex_.Unlock(); }
  MutexLock(const MutexLock&) = delete;
  MutexLock& operator=(const MutexLock&) = delete;

 private:
  Mutex& mutex_;
};

// Waits for a change of what a Mutex guards. The condition is written as a loop at the call, where
// the analysis can see that the mutex is held: `while (!ready_) changed_.Wait(mutex_);`
class CondVar {
 public:
  void Wait(Mutex& mutex) VS_REQUIRES(mutex) {
    std::unique_lock<std::mutex> lock(mutex.mutex_, std::adopt_lock);
    condition_.wait(lock);
    lock.release();
  }
  // False when `timeout` passed first.
  template <class Rep, class Period>
  bool WaitFor(Mutex& mutex, std::chrono::duration<Rep, Period> timeout) VS_REQUIRES(mutex) {
    std::unique_lock<std::mutex> lock(mutex.mutex_, std::adopt_lock);
    const bool woken = condition_.wait_for(lock, timeout) == std::cv_status::no_timeout;
    lock.release();
    return woken;
  }
  void NotifyOne() { condition_.notify_one(); }
  void NotifyAll() { condition_.notify_all(); }

 private:
  std::condition_variable condition_;
};

}  // namespace vs
