#include "server/services/health_board.h"

#include <utility>

namespace vs {

void HealthBoard::Set(const std::string& name, bool serving) {
  {
    MutexLock lock(mutex_);
    const auto [entry, is_new] = serving_.try_emplace(name, serving);
    if (!is_new && entry->second == serving) return;
    entry->second = serving;
  }
  Tell();
}

void HealthBoard::Remove(const std::string& name) {
  {
    MutexLock lock(mutex_);
    if (serving_.erase(name) == 0) return;
  }
  Tell();
}

void HealthBoard::Drain() {
  {
    MutexLock lock(mutex_);
    draining_ = true;
  }
  Tell();
}

std::optional<bool> HealthBoard::Get(const std::string& name) const {
  MutexLock lock(mutex_);
  const auto found = serving_.find(name);
  if (found == serving_.end()) return std::nullopt;
  return found->second && !draining_;
}

std::shared_ptr<void> HealthBoard::Listen(std::function<void()> listener) {
  auto handle = std::make_shared<Listener>(std::move(listener));
  MutexLock lock(mutex_);
  std::erase_if(listeners_, [](const auto& entry) { return entry.expired(); });
  listeners_.push_back(handle);
  return handle;
}

void HealthBoard::Tell() {
  std::vector<std::shared_ptr<Listener>> listeners;
  {
    MutexLock lock(mutex_);
    for (const auto& entry : listeners_) {
      if (auto listener = entry.lock()) listeners.push_back(std::move(listener));
    }
  }
  for (const auto& listener : listeners) (*listener)();
}

}  // namespace vs
