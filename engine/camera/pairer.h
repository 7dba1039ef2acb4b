#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "engine/image/frame.h"

namespace vs {

enum class Side : uint8_t { kLeft = 0, kRight = 1 };

struct PairerOptions {
  // Largest difference of the two capture times of a pair, in effect up to just under half the
  // picture period: beyond that a lost picture would join its neighbour to the wrong partner.
  // 0 = automatic: a quarter of the picture period. Automatic, and as long as the period is
  // unknown, it is at most 5 ms. Not used for cameras that count triggers.
  int64_t tolerance_ns = 0;
};

// Pictures of one side that found no partner, by the reason.
struct Unpaired {
  uint64_t no_counterpart = 0;  // the other camera has no picture of that instant
  uint64_t overflow = 0;        // waited while the other camera delivered nothing
  uint64_t out_of_order = 0;    // older than its predecessor

  uint64_t Total() const { return no_counterpart + overflow + out_of_order; }
  bool operator==(const Unpaired&) const = default;
};

struct PairStats {
  uint64_t pairs = 0;
  Unpaired left;
  Unpaired right;
  // Pictures without a partner since the newest pair.
  uint64_t left_alone = 0;
  uint64_t right_alone = 0;
  bool by_trigger = false;   // how the newest pair was found: by trigger number, else by time
  int64_t tolerance_ns = 0;  // in effect for pairing by time
  // Of abs(right capture - left capture) over the last pairs (at most 256).
  int64_t skew_p50_ns = 0;
  int64_t skew_p99_ns = 0;
  int64_t skew_max_ns = 0;
};

// Finds the two pictures that show the same instant: by trigger number when both cameras count
// triggers (Frame::trigger: sim: and file: do; GigE Vision cameras do not tell it, so that theirs
// are paired by time), else by capture time; never by the order of arrival. Each side may lose
// pictures at any time. Plain logic without threads: the owner calls it under its own lock.
class Pairer {
 public:
  static constexpr size_t kDepth = 4;  // pictures of one side that wait for the other

  explicit Pairer(PairerOptions options = {});

  // Takes the next picture of one side; gives the pair that it completes. A pair has the number of
  // its left picture.
  std::optional<StereoFrame> Add(Side side, FramePtr frame);

  // Pictures of this side that wait for the other one.
  size_t Waiting(Side side) const { return waiting_[Index(side)].count; }
  PairStats Stats() const;

 private:
  // The pictures of one side that wait, oldest first, in fixed memory.
  struct Queue {
    std::array<FramePtr, kDepth> frames;
    size_t first = 0;
    size_t count = 0;

    const FramePtr& Oldest() const { return frames[first]; }
    FramePtr Pop();
    void Push(FramePtr frame);
  };

  static constexpr size_t kSkews = 256;
  static constexpr size_t kIntervals = 16;

  static size_t Index(Side side) { return static_cast<size_t>(side); }
  void CountUnpaired(Side side, uint64_t Unpaired::*reason);
  bool InOrder(Side side, const Frame& frame);
  // Negative: `a` is the older one, its counterpart was lost; 0: they belong together.
  int Compare(const Frame& a, const Frame& b) const;
  int64_t ToleranceNs() const;
  StereoFrame Join(FramePtr left, FramePtr right);

  PairerOptions options_;
  // When and by which trigger a side's last picture was taken.
  struct Instant {
    uint64_t trigger = 0;
    int64_t capture_ns = 0;
    bool known = false;
  };

  std::array<Queue, 2> waiting_;  // never both filled
  std::array<Instant, 2> previous_;
  // The last intervals between pictures of the two sides: the shortest is the picture period.
  std::array<int64_t, kIntervals> intervals_ns_{};
  uint64_t interval_count_ = 0;
  std::array<int64_t, kSkews> skews_ns_{};
  PairStats stats_;
};

}  // namespace vs
