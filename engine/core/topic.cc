#include "engine/core/topic.h"

#include <algorithm>
#include <string_view>
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
    if (!is_tap()) previous = std::exchange(latest_, published);
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
  ++*listeners_;
  return std::shared_ptr<void>(subscription.get(), [subscription, count = listeners_](void*) {
    --*count;
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

std::shared_ptr<Topic> TopicHub::OpenTap(const std::string& name, const std::string& type) {
  MutexLock lock(mutex_);
  auto topic = std::make_shared<Topic>(name, type, Topic::Kind::kTap);
  topics_[name] = topic;
  return topic;
}

std::shared_ptr<Topic> TopicHub::Find(const std::string& name) const {
  MutexLock lock(mutex_);
  const auto found = topics_.find(name);
  return found == topics_.end() ? nullptr : found->second.lock();
}

std::string TopicHub::WhyAbsent(const std::string& name) const {
  const std::string sequence = name.substr(0, name.find('/'));
  const std::string block = name.substr(0, std::min(name.find('.'), name.size()));
  std::string streams;
  std::string outputs;  // of the block
  bool runs = false;
  {
    MutexLock lock(mutex_);
    const auto note = [](std::string_view word, std::string* words) {
      *words += Str(words->empty() ? "" : ", ", word);
    };
    for (auto one = topics_.lower_bound(sequence + "/"); one != topics_.end(); ++one) {
      if (!one->first.starts_with(sequence + "/")) break;
      const auto topic = one->second.lock();
      if (topic == nullptr) continue;
      runs = runs || topic->is_tap();  // they come last and go first
      if (!topic->is_tap())
        note(std::string_view(one->first).substr(sequence.size() + 1), &streams);
      if (one->first.starts_with(block + ".")) {
        note(std::string_view(one->first).substr(block.size() + 1), &outputs);
      }
    }
  }
  if (!runs) return "no running sequence publishes this stream (yet)";
  if (block == name) {
    return Str("sequence ", sequence, " publishes ", streams.empty() ? "nothing" : streams,
               "; an output of a block is ", sequence, "/block.port");
  }
  const std::string id = block.substr(std::min(sequence.size() + 1, block.size()));
  if (outputs.empty())
    return Str("sequence ", sequence, " has no block ", Quoted(id), " with outputs");
  return Str("the outputs of block ", id, " of sequence ", sequence, " are ", outputs, ", without ",
             Quoted(name.substr(block.size() + 1)));
}

std::vector<std::shared_ptr<Topic>> TopicHub::All() const {
  MutexLock lock(mutex_);
  std::vector<std::shared_ptr<Topic>> all;
  for (const auto& [name, weak] : topics_) {
    auto topic = weak.lock();
    if (topic != nullptr && !topic->is_tap()) all.push_back(std::move(topic));
  }
  return all;
}

}  // namespace vs
