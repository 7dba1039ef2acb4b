#pragma once

#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "engine/base/clock.h"
#include "engine/base/mutex.h"
#include "engine/core/topic.h"
#include "server/streams/encoder_pool.h"
#include "server/streams/stream_channel.h"

namespace vs {

// All streams of the server, by name: one channel for each topic that running sequences publish,
// and for each other one (taps among them) that somebody has subscribed to. Thread-safe.
class StreamHub {
 public:
  // Both must outlive it.
  StreamHub(const TopicHub& topics, const Clock& clock, int encoder_threads = 2);
  ~StreamHub();
  StreamHub(const StreamHub&) = delete;
  StreamHub& operator=(const StreamHub&) = delete;

  // The channel of this name, whether there is a topic or not.
  std::shared_ptr<StreamChannel> Channel(const std::string& name) VS_EXCLUDES(mutex_, following_);
  // Those that are live, in the order of their names, without the taps.
  std::vector<std::shared_ptr<StreamChannel>> Live() VS_EXCLUDES(mutex_, following_);

 private:
  void WatchTopics() VS_EXCLUDES(mutex_, following_);
  // Gives all channels their topics, or takes them away.
  void FollowAll() VS_EXCLUDES(mutex_, following_);
  void Follow(StreamChannel& channel) VS_REQUIRES(following_);
  // Those that nobody but the hub knows and that need not be kept: names that somebody waited for
  // in vain, and taps. What is published is little and keeps its count.
  void ForgetUnused() VS_REQUIRES(following_) VS_EXCLUDES(mutex_);
  std::shared_ptr<StreamChannel> FindOrMake(const std::string& name) VS_EXCLUDES(mutex_);
  std::vector<std::shared_ptr<StreamChannel>> Channels() VS_EXCLUDES(mutex_);

  const TopicHub& topics_;
  const Clock& clock_;
  EncoderPool encoders_;
  Mutex following_;  // held while channels follow topics, before mutex_
  Mutex mutex_;
  CondVar changed_;
  bool closing_ VS_GUARDED_BY(mutex_) = false;
  std::map<std::string, std::shared_ptr<StreamChannel>> channels_ VS_GUARDED_BY(mutex_);
  std::jthread watcher_;  // last: everything it uses exists before it starts
};

}  // namespace vs
