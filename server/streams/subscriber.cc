#include "server/streams/subscriber.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "engine/base/str.h"

namespace vs {
namespace {

namespace pb = visionserver::v1;

constexpr uint32_t kMaxWindow = 16;
constexpr uint32_t kDefaultWindow = 2;
constexpr size_t kMaxNameBytes = 128;

std::optional<std::string> FaultOf(const pb::Subscription& wanted) {
  if (wanted.id() == 0) return "the id must be at least 1";
  if (wanted.stream().empty() || wanted.stream().size() > kMaxNameBytes) {
    return "name a stream, such as \"stereo_depth/depth\"";
  }
  if (wanted.window() > kMaxWindow) return Str("window must be 1 to ", kMaxWindow, ", or 0");
  if (!(wanted.max_fps() >= 0 && wanted.max_fps() <= 1000)) {
    return "max_fps must be 0 to 1000";
  }
  if (wanted.jpeg_quality() > 100) return "jpeg_quality must be 1 to 100, or 0";
  if (!pb::Codec_IsValid(wanted.codec())) return "this codec is unknown";
  return std::nullopt;
}

WireMessage NoticeItem(uint32_t subscription_id, const std::string& text) {
  pb::StreamItem item;
  item.set_subscription_id(subscription_id);
  item.set_notice(text);
  return Serialize(item);
}

}  // namespace

Subscriber::Subscriber(std::string id, std::string owner, StreamHub& hub, const Clock& clock)
    : id_(std::move(id)), owner_(std::move(owner)), hub_(hub), clock_(clock) {}

StreamStep Subscriber::Next() {
  const int64_t now_ns = clock_.MonotonicNs();
  MutexLock lock(mutex_);
  if (!greeted_) {
    greeted_ = true;
    pb::StreamItem greeting;
    greeting.set_stream_id(id_);
    return StreamStep::Message(Serialize(greeting));
  }
  if (Status status = UnacknowledgedTooLong(now_ns); !status.ok()) return StreamStep::End(status);
  if (auto item = NextItem(now_ns)) return StreamStep::Message(std::move(*item));
  return StreamStep::Wait(NextTime(now_ns));
}

std::optional<WireMessage> Subscriber::NextItem(int64_t now_ns) {
  // Small things first; among the large ones, whoever has waited longest.
  std::vector<Entry*> order;
  for (auto& [id, entry] : entries_) order.push_back(&entry);
  const auto rank = [](const Entry* entry) {
    return std::tuple(entry->kind != pb::STREAM_KIND_VALUE, entry->last_sent_ns);
  };
  std::stable_sort(order.begin(), order.end(),
                   [&rank](const Entry* a, const Entry* b) { return rank(a) < rank(b); });
  for (Entry* entry : order) {
    if (auto item = NextOf(entry, now_ns)) return item;
  }
  return std::nullopt;
}

std::optional<WireMessage> Subscriber::NextOf(Entry* entry, int64_t now_ns) {
  const pb::Subscription& wanted = entry->wanted;
  const auto notice = [&](const std::string& text) -> std::optional<WireMessage> {
    if (entry->told == text) return std::nullopt;
    entry->told = text;
    return NoticeItem(wanted.id(), text);
  };
  if (!entry->channel->LiveOrWake(waker_)) {
    return notice(entry->channel->absence());
  }
  if (const pb::StreamKind kind = entry->channel->kind(); kind != entry->kind || !entry->encoding) {
    const auto encoding = Resolve(kind, WantedBy(wanted));
    if (!encoding) return notice(encoding.error().message());
    entry->kind = kind;
    entry->encoding = *encoding;
  }
  if (!entry->credit.Allows(now_ns)) return std::nullopt;
  const auto item = entry->channel->Take(*entry->encoding, &entry->want, waker_);
  if (item == nullptr) return std::nullopt;
  entry->want.after_seq = item->seq;
  if (!item->status.ok()) return notice(item->status.message());

  pb::StreamItem head;
  head.set_subscription_id(wanted.id());
  if (entry->last_seq != 0) head.set_dropped(item->seq - entry->last_seq - 1);
  head.set_sent_ns(now_ns);
  entry->credit.OnSent(item->seq, now_ns);
  entry->last_seq = item->seq;
  entry->last_sent_ns = now_ns;
  entry->told.clear();
  // Parts of one message one behind the other are that message.
  WireMessage message = Serialize(head);
  message.insert(message.end(), item->message.begin(), item->message.end());
  return message;
}

Status Subscriber::UnacknowledgedTooLong(int64_t now_ns) const {
  for (const auto& [id, entry] : entries_) {
    const auto since = entry.credit.UnacknowledgedSince();
    if (!since || now_ns - *since < kAckLimitNs) continue;
    return Aborted(Str("subscription ", id, " (", entry.wanted.stream(),
                       ") got no acknowledgement for ", kAckLimitNs / 1'000'000'000,
                       " s: call Ack for the items that you have dealt with"));
  }
  return Status();
}

std::optional<int64_t> Subscriber::NextTime(int64_t now_ns) const {
  std::optional<int64_t> next;
  const auto consider = [&next](int64_t time_ns) {
    next = next ? std::min(*next, time_ns) : time_ns;
  };
  for (const auto& [id, entry] : entries_) {
    if (const auto since = entry.credit.UnacknowledgedSince()) consider(*since + kAckLimitNs);
    if (const auto from = entry.credit.AllowedFrom(); from && *from > now_ns) consider(*from);
  }
  return next;
}

Status Subscriber::Update(const std::vector<pb::Subscription>& set,
                          const std::vector<uint32_t>& remove) {
  std::vector<Fault> faults;
  for (const pb::Subscription& wanted : set) {
    if (auto fault = FaultOf(wanted)) {
      faults.push_back({Str("subscription ", wanted.id()), std::move(*fault)});
    }
  }
  if (!faults.empty()) {
    const std::string first = faults.front().subject + ": " + faults.front().message;
    return Status(StatusCode::kInvalidArgument, first, std::move(faults));
  }
  std::map<uint32_t, Entry> made;
  for (const pb::Subscription& wanted : set) {
    made.insert_or_assign(
        wanted.id(), Entry{.wanted = wanted,
                           .channel = hub_.Channel(wanted.stream()),
                           .credit = Credit(wanted.window() == 0 ? kDefaultWindow : wanted.window(),
                                            wanted.max_fps())});
  }
  {
    MutexLock lock(mutex_);
    size_t added = 0;
    for (const auto& [id, entry] : made) added += entries_.contains(id) ? 0 : 1;
    if (entries_.size() + added > kMaxSubscriptions) {
      return ResourceExhausted(
          Str("one stream takes at most ", kMaxSubscriptions, " subscriptions"));
    }
    for (auto& [id, entry] : made) {
      // Another codec or rate of the same stream: what it has is not sent again, and what it has
      // not acknowledged still counts.
      const auto old = entries_.find(id);
      if (old != entries_.end() && old->second.channel == entry.channel) {
        entry.want.after_seq = entry.last_seq = old->second.last_seq;
        entry.credit.Continue(old->second.credit);
      }
      entries_.insert_or_assign(id, std::move(entry));
    }
    for (const uint32_t id : remove) entries_.erase(id);
  }
  if (waker_->wake) waker_->wake();
  return Status();
}

void Subscriber::Ack(const std::vector<pb::Acknowledgement>& items) {
  {
    MutexLock lock(mutex_);
    for (const pb::Acknowledgement& one : items) {
      const auto entry = entries_.find(one.subscription_id());
      if (entry != entries_.end()) entry->second.credit.OnAck(one.seq());
    }
  }
  if (waker_->wake) waker_->wake();
}

void Subscriber::CountStreams(std::map<std::string, uint32_t>* counts) const {
  MutexLock lock(mutex_);
  for (const auto& [id, entry] : entries_) ++(*counts)[entry.wanted.stream()];
}

}  // namespace vs
