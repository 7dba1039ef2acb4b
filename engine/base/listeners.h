#pragma once

#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "engine/base/mutex.h"

namespace vs {

// Functions that want to be called when something happens. Thread-safe.
template <class... Arguments>
class Listeners {
 public:
  using Function = std::function<void(const Arguments&...)>;

  // `listener` is called until the returned handle goes; after that it is never called again, and
  // dropping the handle waits for a call that is under way. So it must not drop its own handle.
  [[nodiscard]] std::shared_ptr<void> Add(Function listener) VS_EXCLUDES(mutex_) {
    auto entry = std::make_shared<Entry>();
    entry->listener = std::move(listener);
    {
      MutexLock lock(mutex_);
      entries_.push_back(entry);
    }
    return std::shared_ptr<void>(entry.get(), [entry](void*) {
      MutexLock lock(entry->mutex);
      entry->listener = nullptr;
    });
  }

  // Calls all of them, one after the other, on this thread.
  void Call(const Arguments&... arguments) VS_EXCLUDES(mutex_) {
    std::vector<std::shared_ptr<Entry>> entries;
    {
      MutexLock lock(mutex_);
      std::erase_if(entries_, [](const auto& weak) { return weak.expired(); });
      for (const auto& weak : entries_) {
        if (auto entry = weak.lock()) entries.push_back(std::move(entry));
      }
    }
    for (const auto& entry : entries) {
      MutexLock lock(entry->mutex);
      if (entry->listener) entry->listener(arguments...);
    }
  }

 private:
  struct Entry {
    Mutex mutex;
    Function listener;  // under `mutex`, once others know the entry
  };

  Mutex mutex_;
  std::vector<std::weak_ptr<Entry>> entries_ VS_GUARDED_BY(mutex_);
};

}  // namespace vs
