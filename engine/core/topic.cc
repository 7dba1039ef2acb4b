#include "engine/core/topic.h"

#include <utility>

#include "engine/base/str.h"

namespace vs {

// The lock makes "after the handle is gone the listener is not called" true while another thread
// is publishing.
struct Topic::Subscription {
  explicit Subscription(Listener f) : listener(std::move(f)) {}

  Mutex mutex;
  Listener listener VS_GUARDED_BY(mutex);
};

void Topic::Publish(Value value, const FrameContext& frame, int64_t published_ns) {
  std::shared_ptr<const Sample> previous;  // freed after the lock
  std::shared_ptr<const Sample> published;
  std::shared_ptr<const Subscriptions> subscriptions;
  {
    MutexLock lock(mutex_);
    published = std::allocate_shared<Sample>(
        samples_, Sample{next_seq_++, std::move(value), frame, published_ns});
    previous = std::exchange(latest_, published);
    subscriptions = subscriptions_;
  }
  if (subscriptions == nullptr) return;
  for (const auto& weak : *subscriptions) {
    const auto subscription = weak.lock();
    if (subscription == nullptr) continue;
    MutexLock lock(subscription->mutex);
    if (subscription->listener) subscription->listener(published);
  }
}

std::shared_ptr<const Sample> Topic::Latest() const {
  MutexLock lock(mutex_);
  return latest_;
}

std::shared_ptr<void> Topic::Listen(Listener listener) {
  auto subscription = std::make_shared<Subscription>(std::move(listener));
  {
    MutexLock lock(mutex_);
    auto all = std::make_shared<Subscriptions>();
    if (subscriptions_ != nullptr) {
      for (const auto& other : *subscriptions_) {
        if (!other.expired()) all->push_back(other);
      }
    }
    all->push_back(subscription);
    subscriptions_ = std::move(all);
  }
  return std::shared_ptr<void>(subscription.get(), [subscription](void*) {
    MutexLock lock(subscription->mutex);
    subscription->listener = nullptr;
  });
}

Result<std::shared_ptr<Topic>> TopicHub::Open(const std::string& name, const std::string& type) {
  MutexLock lock(mutex_);
  std::erase_if(topics_, [](const auto& entry) { return entry.second.expired(); });
  std::weak_ptr<Topic>& entry = topics_[name];
  if (!entry.expired()) {
    return AlreadyExists(
        Str("a running sequence already publishes \"", name, "\": choose another name"));
  }
  auto topic = std::make_shared<Topic>(name, type);
  entry = topic;
  return topic;
}

std::shared_ptr<Topic> TopicHub::Find(const std::string& name) const {
  MutexLock lock(mutex_);
  const auto found = topics_.find(name);
  return found == topics_.end() ? nullptr : found->second.lock();
}

std::vector<std::shared_ptr<Topic>> TopicHub::All() const {
  MutexLock lock(mutex_);
  std::vector<std::shared_ptr<Topic>> all;
  for (const auto& [name, weak] : topics_) {
    if (auto topic = weak.lock()) all.push_back(std::move(topic));
  }
  return all;
}

}  // namespace vs
