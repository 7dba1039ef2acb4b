#include "server/streams/stream_hub.h"

#include <utility>

namespace vs {
namespace {

// A topic that has come or gone is noticed after this time.
constexpr std::chrono::milliseconds kWatchPeriod{50};

}  // namespace

StreamHub::StreamHub(const TopicHub& topics, const Clock& clock, int encoder_threads)
    : topics_(topics), clock_(clock), encoders_(encoder_threads, clock) {
  watcher_ = std::jthread([this] { WatchTopics(); });
}

StreamHub::~StreamHub() {
  {
    MutexLock lock(mutex_);
    closing_ = true;
  }
  changed_.NotifyAll();
  watcher_.join();
  // Nothing is published into them any more while the encoders go.
  for (const auto& channel : Channels()) channel->Follow(nullptr, clock_.MonotonicNs());
}

std::shared_ptr<StreamChannel> StreamHub::Channel(const std::string& name) {
  auto channel = FindOrMake(name);
  MutexLock following(following_);
  channel->Follow(topics_.Find(name), clock_.MonotonicNs());
  return channel;
}

std::vector<std::shared_ptr<StreamChannel>> StreamHub::Live() {
  FollowAll();
  std::vector<std::shared_ptr<StreamChannel>> live = Channels();
  std::erase_if(live, [](const auto& channel) { return !channel->live(); });
  return live;
}

void StreamHub::WatchTopics() {
  while (true) {
    {
      MutexLock lock(mutex_);
      if (!closing_) changed_.WaitFor(mutex_, kWatchPeriod);
      if (closing_) return;
    }
    FollowAll();
  }
}

void StreamHub::FollowAll() {
  MutexLock following(following_);
  const int64_t now_ns = clock_.MonotonicNs();
  for (const auto& topic : topics_.All()) FindOrMake(topic->name());
  for (const auto& channel : Channels()) channel->Follow(topics_.Find(channel->name()), now_ns);
  // Names that somebody waited for in vain; those of real streams are few and keep their count.
  MutexLock lock(mutex_);
  std::erase_if(channels_, [](const auto& entry) {
    return entry.second.use_count() == 1 && !entry.second->live() &&
           entry.second->kind() == visionserver::v1::STREAM_KIND_UNSPECIFIED;
  });
}

std::shared_ptr<StreamChannel> StreamHub::FindOrMake(const std::string& name) {
  MutexLock lock(mutex_);
  std::shared_ptr<StreamChannel>& channel = channels_[name];
  if (channel == nullptr) channel = std::make_shared<StreamChannel>(name, encoders_);
  return channel;
}

std::vector<std::shared_ptr<StreamChannel>> StreamHub::Channels() {
  MutexLock lock(mutex_);
  std::vector<std::shared_ptr<StreamChannel>> channels;
  for (const auto& [name, channel] : channels_) channels.push_back(channel);
  return channels;
}

}  // namespace vs
