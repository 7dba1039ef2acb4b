#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>

#include "engine/base/mutex.h"
#include "engine/core/topic.h"
#include "server/streams/encoder_pool.h"
#include "server/streams/encoding.h"
#include "server/streams/frame_encoder.h"

namespace vs {

// Somebody who wants to be told. May be called from any thread and only takes note.
struct Waker {
  std::function<void()> wake;
};

// What one subscriber wants next from a channel.
struct Want {
  uint64_t after_seq = 0;  // only what is newer than this
  uint64_t at_least = 0;   // kept by Take between calls; 0 for a new wish
};

// One stream for all of its subscribers: holds the newest published value and packs it once for
// each encoding that somebody wants. What nobody waits for is never packed. Thread-safe.
//
// A stream outlives the topic behind it: when its sequence is started again, there is a new topic
// of the same name, and the numbers of the items go on.
class StreamChannel : public std::enable_shared_from_this<StreamChannel> {
 public:
  // `encoders` must outlive it.
  StreamChannel(std::string name, EncoderPool& encoders)
      : name_(std::move(name)), encoders_(encoders) {}

  const std::string& name() const { return name_; }

  // Whether its topic is there. Called several times a second: follows a topic that has come
  // (null: there is none now, and `absence` says why), and forgets packed items that nobody wanted
  // for a while.
  void Follow(const std::shared_ptr<Topic>& topic, const std::string& absence, int64_t now_ns)
      VS_EXCLUDES(mutex_);

  bool live() const VS_EXCLUDES(mutex_);
  // Of an output that clients look at without its being published.
  bool is_tap() const VS_EXCLUDES(mutex_);
  // Why it is not live, for people.
  std::string absence() const VS_EXCLUDES(mutex_);
  // The same as live(); when it is not, `waker` is woken once it is, or why it is not has changed.
  bool LiveOrWake(const std::shared_ptr<Waker>& waker) VS_EXCLUDES(mutex_);
  visionserver::v1::StreamKind kind() const VS_EXCLUDES(mutex_);
  // The newest value with the number that clients see; null and 0 when there is none.
  std::pair<std::shared_ptr<const Sample>, uint64_t> Newest() const VS_EXCLUDES(mutex_);

  // The newest item as `encoding`, if it is packed already. Otherwise null: `waker` is woken once
  // when it is worth while to ask again with the same `want`.
  std::shared_ptr<const EncodedItem> Take(const Encoding& encoding, Want* want,
                                          const std::shared_ptr<Waker>& waker) VS_EXCLUDES(mutex_);

 private:
  using Wakers = std::set<std::shared_ptr<Waker>>;
  // The items of one encoding.
  struct Packed {
    std::shared_ptr<const EncodedItem> item;
    uint64_t packing_seq = 0;  // 0: nobody packs at this moment
    Wakers waiting;
    int64_t wanted_ns = 0;
  };

  void ForgetUnwanted() VS_REQUIRES(mutex_);
  void ListenTo(const std::shared_ptr<Topic>& topic) VS_EXCLUDES(mutex_);
  void OnSample(const std::shared_ptr<const Sample>& sample) VS_EXCLUDES(mutex_);
  bool IsQuick() const VS_REQUIRES(mutex_);
  void BeginPacking(const Encoding& encoding, Packed* packed) VS_REQUIRES(mutex_);
  void PackHere(const Encoding& encoding, Packed* packed) VS_REQUIRES(mutex_);
  void FinishPacking(const Encoding& encoding, std::shared_ptr<const EncodedItem> item)
      VS_EXCLUDES(mutex_);
  static void Wake(const Wakers& wakers);

  const std::string name_;
  EncoderPool& encoders_;
  mutable Mutex mutex_;
  std::weak_ptr<Topic> topic_ VS_GUARDED_BY(mutex_);
  std::shared_ptr<void> listening_ VS_GUARDED_BY(mutex_);
  bool is_tap_ VS_GUARDED_BY(mutex_) = false;
  std::string absence_ VS_GUARDED_BY(mutex_);
  visionserver::v1::StreamKind kind_ VS_GUARDED_BY(mutex_) =
      visionserver::v1::STREAM_KIND_UNSPECIFIED;
  std::shared_ptr<const Sample> newest_ VS_GUARDED_BY(mutex_);
  uint64_t newest_seq_ VS_GUARDED_BY(mutex_) = 0;  // stays when the topic goes
  uint64_t first_seq_ VS_GUARDED_BY(mutex_) = 0;   // newest_seq_ when the topic came
  int64_t now_ns_ VS_GUARDED_BY(mutex_) = 0;       // of the last Follow
  std::map<Encoding, Packed> packed_ VS_GUARDED_BY(mutex_);
  Wakers waiting_for_topic_ VS_GUARDED_BY(mutex_);
};

}  // namespace vs
