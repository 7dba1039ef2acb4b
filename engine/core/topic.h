#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/mutex.h"
#include "engine/base/recycler.h"
#include "engine/base/status.h"
#include "engine/core/frame_context.h"
#include "engine/core/value.h"

namespace vs {

// One published value with the frame it belongs to.
struct Sample {
  uint64_t seq = 0;  // of the topic, from 1, without gaps
  Value value;
  FrameContext frame;
  int64_t published_ns = 0;  // host's monotonic clock
};

// The newest value of a published output. Slow readers skip; nobody ever queues. Thread-safe.
class Topic {
 public:
  using Listener = std::function<void(const std::shared_ptr<const Sample>&)>;
  enum class Kind {
    kStream,  // published for clients to find
    kTap,     // of an output that somebody may or may not look at: keeps no value, is not listed
  };

  Topic(std::string name, std::string type, Kind kind = Kind::kStream)
      : name_(std::move(name)), type_(std::move(type)), kind_(kind) {}

  const std::string& name() const { return name_; }  // "stereo_depth/depth"
  const std::string& type() const { return type_; }  // port type of its values
  bool is_tap() const { return kind_ == Kind::kTap; }

  // Takes no heap memory once warm. Called by one thread after the other.
  void Publish(Value value, const FrameContext& frame, int64_t published_ns);
  // Null before the first value, and always of a tap.
  std::shared_ptr<const Sample> Latest() const;

  // Calls `listener` on the publishing thread for every new sample; it must only take note (swap a
  // pointer, wake somebody) and must not drop its own handle. The subscription ends when the
  // returned handle goes; after that the listener is not called any more.
  [[nodiscard]] std::shared_ptr<void> Listen(Listener listener);
  // Whether any handle of Listen is left.
  bool HasListeners() const { return listeners_->load(std::memory_order_relaxed) > 0; }

 private:
  struct Subscription;
  using Subscriptions = std::vector<std::weak_ptr<Subscription>>;

  const std::string name_;
  const std::string type_;
  const Kind kind_;
  const std::shared_ptr<std::atomic<int>> listeners_ = std::make_shared<std::atomic<int>>(0);
  Recycler<Sample> samples_;
  mutable Mutex mutex_;
  std::shared_ptr<const Sample> latest_ VS_GUARDED_BY(mutex_);
  uint64_t next_seq_ VS_GUARDED_BY(mutex_) = 1;
  // Replaced as a whole, so that a publisher walks its list without the lock.
  std::shared_ptr<const Subscriptions> subscriptions_ VS_GUARDED_BY(mutex_);
};

// All topics of the server. A publish block opens one in Start() and drops it in Stop(); readers
// that hold it just see no new samples. Thread-safe.
class TopicHub {
 public:
  // ALREADY_EXISTS when a running sequence publishes under this name.
  Result<std::shared_ptr<Topic>> Open(const std::string& name, const std::string& type);
  // For Taps, whose names are theirs alone: "sequence/block.port".
  std::shared_ptr<Topic> OpenTap(const std::string& name, const std::string& type);
  // Null when nothing is published under this name now.
  std::shared_ptr<Topic> Find(const std::string& name) const;
  // Why Find gives null, for people: what of the name is not there, and what is there instead.
  std::string WhyAbsent(const std::string& name) const;
  // Sorted by name, without the taps.
  std::vector<std::shared_ptr<Topic>> All() const;

 private:
  mutable Mutex mutex_;
  std::map<std::string, std::weak_ptr<Topic>> topics_ VS_GUARDED_BY(mutex_);
};

}  // namespace vs
