#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

namespace vs {

// How much one subscription may send: at most `window` items without acknowledgement, at most
// `max_fps` items a second. Without it a client that is slower than the source would fall seconds
// behind, because network and system buffers take many items (FrameHeader.capture_ns shows it).
// Times are of one monotonic clock. Not thread-safe.
class Credit {
 public:
  // window 1..16; max_fps 0 for no limit.
  Credit(size_t window, double max_fps);

  // Whether an item may be sent now.
  bool Allows(int64_t now_ns) const { return sent_.size() < window_ && now_ns >= due_ns_; }
  // When only the rate forbids to send: until then. Nothing while acknowledgements are missing.
  std::optional<int64_t> AllowedFrom() const;

  // Goes on where `before` was: what it sent is still under way, and the pace is counted from then.
  void Continue(const Credit& before);

  void OnSent(uint64_t seq, int64_t now_ns);
  // The client has dealt with this item and all earlier ones. What was never sent changes nothing.
  void OnAck(uint64_t seq);

  // When the oldest item was sent that is not acknowledged; nothing when there is none.
  std::optional<int64_t> UnacknowledgedSince() const;

 private:
  struct Sent {
    uint64_t seq;
    int64_t time_ns;
  };

  size_t window_;
  int64_t period_ns_;
  std::deque<Sent> sent_;  // without acknowledgement, oldest first
  int64_t due_ns_ = 0;
};

}  // namespace vs
