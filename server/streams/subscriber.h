#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "visionserver/v1/stream.pb.h"

#include "engine/base/clock.h"
#include "engine/base/mutex.h"
#include "engine/base/status.h"
#include "server/rpc/stream_source.h"
#include "server/streams/credit.h"
#include "server/streams/stream_hub.h"

namespace vs {

// One open Subscribe: all that one client wants to see, and how far it has got. Thread-safe.
class Subscriber {
 public:
  // A client that leaves an item without acknowledgement for so long loses its stream.
  static constexpr int64_t kAckLimitNs = 30'000'000'000;
  static constexpr size_t kMaxSubscriptions = 64;

  // `id` names it in Ack and UpdateSubscriptions; `owner` is the credential that opened it. Both
  // references must outlive it.
  Subscriber(std::string id, std::string owner, StreamHub& hub, const Clock& clock);

  const std::string& id() const { return id_; }
  const std::string& owner() const { return owner_; }

  void OnWake(std::function<void()> wake) { waker_->wake = std::move(wake); }
  // What to send next.
  StreamStep Next() VS_EXCLUDES(mutex_);

  // Adds or replaces subscriptions, then removes some. All or nothing: INVALID_ARGUMENT with all
  // faults.
  Status Update(const std::vector<visionserver::v1::Subscription>& set,
                const std::vector<uint32_t>& remove) VS_EXCLUDES(mutex_);
  void Ack(const std::vector<visionserver::v1::Acknowledgement>& items) VS_EXCLUDES(mutex_);

  // Adds the names of the streams that it is subscribed to.
  void CountStreams(std::map<std::string, uint32_t>* counts) const VS_EXCLUDES(mutex_);

 private:
  struct Entry {
    visionserver::v1::Subscription wanted;
    std::shared_ptr<StreamChannel> channel;
    Credit credit;
    visionserver::v1::StreamKind kind = visionserver::v1::STREAM_KIND_UNSPECIFIED;
    std::optional<Encoding> encoding{};  // for `kind`; absent when that cannot be had
    Want want{};
    uint64_t last_seq = 0;  // of the item before; 0 = none yet
    int64_t last_sent_ns = 0;
    std::string told{};  // the last notice; empty when items flow
  };

  std::optional<WireMessage> NextItem(int64_t now_ns) VS_REQUIRES(mutex_);
  std::optional<WireMessage> NextOf(Entry* entry, int64_t now_ns) VS_REQUIRES(mutex_);
  Status UnacknowledgedTooLong(int64_t now_ns) const VS_REQUIRES(mutex_);
  std::optional<int64_t> NextTime(int64_t now_ns) const VS_REQUIRES(mutex_);

  const std::string id_;
  const std::string owner_;
  StreamHub& hub_;
  const Clock& clock_;
  const std::shared_ptr<Waker> waker_ = std::make_shared<Waker>();
  mutable Mutex mutex_;
  bool greeted_ VS_GUARDED_BY(mutex_) = false;
  std::map<uint32_t, Entry> entries_ VS_GUARDED_BY(mutex_);
};

}  // namespace vs
