#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "engine/core/frame_context.h"
#include "engine/core/sequence.h"
#include "engine/core/topic.h"
#include "engine/core/value.h"

namespace vs {

// Lets anybody look at any output of a running sequence, without a block for it: a topic
// "sequence/block.port" for each, open from start to stop. As long as nobody listens to it, a tap
// costs one look at a counter for each frame and holds on to nothing.
class Taps {
 public:
  Taps() = default;  // of a sequence that runs without a server: none
  Taps(const Sequence& sequence, TopicHub& hub);

  // `value` is what a block has just put out, not empty. Publishes it if somebody listens. Takes no
  // heap memory once warm. One frame after the other for each slot.
  void Offer(int slot, const Value& value, const FrameContext& frame, int64_t now_ns) const {
    if (topics_.empty() || !topics_[slot]->HasListeners()) return;
    topics_[slot]->Publish(value, frame, now_ns);
  }

 private:
  std::vector<std::shared_ptr<Topic>> topics_;  // by slot
};

}  // namespace vs
