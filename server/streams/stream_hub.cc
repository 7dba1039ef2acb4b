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
  for (const auto& channel : Channels()) channel->Follow(nullptr, "", clock_.MonotonicNs());
}

std::shared_ptr<StreamChannel> StreamHub::Channel(const std::string& name) {
  auto channel = FindOrMake(name);
  MutexLock following(following_);
  Follow(*channel);
  return channel;
}

std::vector<std::shared_ptr<StreamChannel>> StreamHub::Live() {
  FollowAll();
  std::vector<std::shared_ptr<StreamChannel>> live = Channels();
  std::erase_if(live, [](const auto& channel) { return !channel->live() || channel->is_tap(); });
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
  for (const auto& topic : topics_.All()) FindOrMake(topic->name());
  for (const auto& channel : Channels()) Follow(*channel);
  ForgetUnused();
}

void StreamHub::Follow(StreamChannel& channel) {
  const auto topic = topics_.Find(channel.name());
  channel.Follow(topic, topic == nullptr ? topics_.WhyAbsent(channel.name()) : "",
                 clock_.MonotonicNs());
}

void StreamHub::ForgetUnused() {
  const auto unused = [](const std::shared_ptr<StreamChannel>& channel) {
    return channel.use_count() == 1 &&
           (channel->is_tap() ||
            (!channel->live() && channel->kind() == visionserver::v1::STREAM_KIND_UNSPECIFIED));
  };
  std::vector<std::shared_ptr<StreamChannel>> going;
  {
    MutexLock lock(mutex_);
    for (const auto& [name, channel] : channels_) {
      if (unused(channel)) going.push_back(channel);
    }
  }
  // A channel must not go while it listens: its last owner could be the listener itself.
  for (const auto& channel : going) channel->Follow(nullptr, "", clock_.MonotonicNs());
  going.clear();
  MutexLock lock(mutex_);
  std::erase_if(channels_,
                [&](const auto& entry) { return unused(entry.second) && !entry.second->live(); });
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
