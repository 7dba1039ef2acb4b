#include "server/streams/stream_channel.h"

#include <algorithm>
#include <utility>

namespace vs {
namespace {

namespace pb = visionserver::v1;

// Packed items that nobody asked for so long are forgotten.
constexpr int64_t kForgetNs = 5'000'000'000;

// Removes those whose subscribers have gone: nobody else knows them.
void Prune(std::set<std::shared_ptr<Waker>>* wakers) {
  std::erase_if(*wakers, [](const auto& waker) { return waker.use_count() == 1; });
}

}  // namespace

void StreamChannel::Follow(const std::shared_ptr<Topic>& topic, const std::string& absence,
                           int64_t now_ns) {
  std::shared_ptr<void> old;  // dropped without the lock: a listener may be waiting for it
  Wakers wakers;
  bool changed = false;
  {
    MutexLock lock(mutex_);
    now_ns_ = now_ns;
    ForgetUnwanted();
    changed =
        topic == nullptr ? listening_ != nullptr : listening_ == nullptr || topic_.lock() != topic;
    if (topic == nullptr && absence != absence_) {
      absence_ = absence;
      wakers = std::exchange(waiting_for_topic_, {});
    }
    if (changed) {
      old = std::exchange(listening_, nullptr);
      topic_ = topic;
      newest_ = nullptr;
      first_seq_ = newest_seq_;
      for (auto& [encoding, packed] : packed_) {
        packed.item = nullptr;
        wakers.merge(std::exchange(packed.waiting, {}));
      }
    }
  }
  old.reset();
  if (changed && topic != nullptr) ListenTo(topic);
  Wake(wakers);
}

void StreamChannel::ForgetUnwanted() {
  for (auto& [encoding, packed] : packed_) Prune(&packed.waiting);
  std::erase_if(packed_, [now_ns = now_ns_](const auto& entry) {
    const Packed& packed = entry.second;
    return packed.waiting.empty() && packed.packing_seq == 0 &&
           now_ns - packed.wanted_ns > kForgetNs;
  });
  Prune(&waiting_for_topic_);
}

void StreamChannel::ListenTo(const std::shared_ptr<Topic>& topic) {
  std::shared_ptr<void> listening =
      topic->Listen([weak = weak_from_this()](const std::shared_ptr<const Sample>& sample) {
        if (const auto self = weak.lock()) self->OnSample(sample);
      });
  Wakers wakers;
  {
    MutexLock lock(mutex_);
    kind_ = KindOf(topic->type());
    is_tap_ = topic->is_tap();
    absence_.clear();
    listening_ = std::move(listening);
    wakers = std::exchange(waiting_for_topic_, {});
  }
  // Published before this channel listened.
  if (const auto latest = topic->Latest()) OnSample(latest);
  Wake(wakers);
}

bool StreamChannel::live() const {
  MutexLock lock(mutex_);
  return listening_ != nullptr;
}

bool StreamChannel::is_tap() const {
  MutexLock lock(mutex_);
  return is_tap_;
}

std::string StreamChannel::absence() const {
  MutexLock lock(mutex_);
  return absence_;
}

bool StreamChannel::LiveOrWake(const std::shared_ptr<Waker>& waker) {
  MutexLock lock(mutex_);
  if (listening_ != nullptr) return true;
  waiting_for_topic_.insert(waker);
  return false;
}

pb::StreamKind StreamChannel::kind() const {
  MutexLock lock(mutex_);
  return kind_;
}

std::pair<std::shared_ptr<const Sample>, uint64_t> StreamChannel::Newest() const {
  MutexLock lock(mutex_);
  return {newest_, newest_ == nullptr ? 0 : newest_seq_};
}

std::shared_ptr<const EncodedItem> StreamChannel::Take(const Encoding& encoding, Want* want,
                                                       const std::shared_ptr<Waker>& waker) {
  MutexLock lock(mutex_);
  Packed& packed = packed_[encoding];
  packed.wanted_ns = now_ns_;
  const bool has_newer = newest_ != nullptr && newest_seq_ > want->after_seq;
  // What was the newest at the first asking is good enough: whoever insisted on the newest of each
  // moment would get nothing when packing takes longer than a frame.
  if (want->at_least <= want->after_seq) {
    want->at_least = has_newer ? newest_seq_ : want->after_seq + 1;
  }
  if (has_newer && packed.packing_seq == 0 &&
      (packed.item == nullptr || packed.item->seq < want->at_least)) {
    if (IsQuick()) {
      PackHere(encoding, &packed);
    } else {
      BeginPacking(encoding, &packed);
    }
  }
  if (packed.item != nullptr && packed.item->seq >= want->at_least) {
    want->at_least = 0;
    packed.waiting.erase(waker);
    return packed.item;
  }
  packed.waiting.insert(waker);
  return nullptr;
}

void StreamChannel::OnSample(const std::shared_ptr<const Sample>& sample) {
  Wakers wakers;
  {
    MutexLock lock(mutex_);
    if (first_seq_ + sample->seq <= newest_seq_) return;
    newest_ = sample;
    newest_seq_ = first_seq_ + sample->seq;
    for (auto& [encoding, packed] : packed_) {
      if (packed.waiting.empty() || packed.packing_seq != 0) continue;
      if (IsQuick()) {
        wakers.merge(std::exchange(packed.waiting, {}));
      } else {
        BeginPacking(encoding, &packed);
      }
    }
  }
  Wake(wakers);
}

bool StreamChannel::IsQuick() const { return kind_ == pb::STREAM_KIND_VALUE; }

void StreamChannel::BeginPacking(const Encoding& encoding, Packed* packed) {
  packed->packing_seq = newest_seq_;
  const bool posted = encoders_.Post([self = shared_from_this(), encoding, sample = newest_,
                                      seq = newest_seq_](FrameEncoder& encoder) {
    self->FinishPacking(encoding, encoder.Encode(sample, seq, encoding));
  });
  // The next sample tries again.
  if (!posted) packed->packing_seq = 0;
}

void StreamChannel::PackHere(const Encoding& encoding, Packed* packed) {
  const std::shared_ptr<const Sample> sample = newest_;
  const uint64_t seq = newest_seq_;
  encoders_.RunHere(
      [&](FrameEncoder& encoder) { packed->item = encoder.Encode(sample, seq, encoding); });
}

void StreamChannel::FinishPacking(const Encoding& encoding,
                                  std::shared_ptr<const EncodedItem> item) {
  Wakers wakers;
  {
    MutexLock lock(mutex_);
    Packed& packed = packed_[encoding];
    packed.packing_seq = 0;
    if (item->seq > first_seq_) packed.item = std::move(item);  // else of a topic that is gone
    wakers = std::exchange(packed.waiting, {});
  }
  Wake(wakers);
}

void StreamChannel::Wake(const Wakers& wakers) {
  for (const auto& waker : wakers) waker->wake();
}

}  // namespace vs
