#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/mutex.h"

namespace vs {

// What is well and what is not, by name: "" is the server, "sequences/ID" a sequence. Thread-safe.
class HealthBoard {
 public:
  // The server itself is well from the start.
  HealthBoard() { serving_[""] = true; }

  void Set(const std::string& name, bool serving);
  void Remove(const std::string& name);
  // From now on nothing is well, whatever is set.
  void Drain();

  // Nothing: there is nothing of that name.
  std::optional<bool> Get(const std::string& name) const;

  // Calls `listener`, which only takes note, after each change until the handle goes.
  [[nodiscard]] std::shared_ptr<void> Listen(std::function<void()> listener);

 private:
  using Listener = std::function<void()>;
  void Tell() VS_EXCLUDES(mutex_);

  mutable Mutex mutex_;
  std::map<std::string, bool> serving_ VS_GUARDED_BY(mutex_);
  bool draining_ VS_GUARDED_BY(mutex_) = false;
  std::vector<std::weak_ptr<Listener>> listeners_ VS_GUARDED_BY(mutex_);
};

}  // namespace vs
