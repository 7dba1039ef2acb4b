#include "engine/camera/pairer.h"

#include <algorithm>
#include <utility>

namespace vs {
namespace {

// Shorter than half the picture period of all but the fastest cameras.
constexpr int64_t kCautiousNs = 5'000'000;

bool CountTriggers(const Frame& a, const Frame& b) { return a.trigger != 0 && b.trigger != 0; }

}  // namespace

Pairer::Pairer(PairerOptions options) : options_(options) {}

FramePtr Pairer::Queue::Pop() {
  FramePtr frame = std::move(frames[first]);
  first = (first + 1) % kDepth;
  --count;
  return frame;
}

void Pairer::Queue::Push(FramePtr frame) {
  frames[(first + count) % kDepth] = std::move(frame);
  ++count;
}

std::optional<StereoFrame> Pairer::Add(Side side, FramePtr frame) {
  const Side other = side == Side::kLeft ? Side::kRight : Side::kLeft;
  if (!InOrder(side, *frame)) {
    CountUnpaired(side, &Unpaired::out_of_order);
    return std::nullopt;
  }
  Queue& others = waiting_[Index(other)];
  while (others.count > 0) {
    const int order = Compare(*others.Oldest(), *frame);
    if (order > 0) {
      CountUnpaired(side, &Unpaired::no_counterpart);
      return std::nullopt;
    }
    FramePtr oldest = others.Pop();
    if (order == 0) {
      return side == Side::kLeft ? Join(std::move(frame), std::move(oldest))
                                 : Join(std::move(oldest), std::move(frame));
    }
    CountUnpaired(other, &Unpaired::no_counterpart);
  }
  Queue& own = waiting_[Index(side)];
  if (own.count == kDepth) {
    own.Pop();
    CountUnpaired(side, &Unpaired::overflow);
  }
  own.Push(std::move(frame));
  return std::nullopt;
}

void Pairer::CountUnpaired(Side side, uint64_t Unpaired::*reason) {
  const bool left = side == Side::kLeft;
  Unpaired& unpaired = left ? stats_.left : stats_.right;
  ++(unpaired.*reason);
  ++(left ? stats_.left_alone : stats_.right_alone);
}

bool Pairer::InOrder(Side side, const Frame& frame) {
  const Instant previous =
      std::exchange(previous_[Index(side)], {frame.trigger, frame.capture_ns, true});
  if (!previous.known) return true;
  const int64_t interval_ns = frame.capture_ns - previous.capture_ns;
  if (interval_ns > 0) intervals_ns_[interval_count_++ % kIntervals] = interval_ns;
  if (frame.trigger != 0 && previous.trigger != 0) return frame.trigger > previous.trigger;
  return interval_ns > 0;
}

int Pairer::Compare(const Frame& a, const Frame& b) const {
  if (CountTriggers(a, b)) return a.trigger < b.trigger ? -1 : a.trigger > b.trigger ? 1 : 0;
  const int64_t difference_ns = a.capture_ns - b.capture_ns;
  const int64_t tolerance_ns = ToleranceNs();
  return difference_ns < -tolerance_ns ? -1 : difference_ns > tolerance_ns ? 1 : 0;
}

int64_t Pairer::ToleranceNs() const {
  const int64_t asked_ns = options_.tolerance_ns;
  const size_t known = std::min<uint64_t>(interval_count_, kIntervals);
  if (known == 0) return asked_ns == 0 ? kCautiousNs : std::min(asked_ns, kCautiousNs);
  const int64_t period_ns = *std::min_element(intervals_ns_.begin(), intervals_ns_.begin() + known);
  if (asked_ns == 0) return std::min(kCautiousNs, period_ns / 4);
  // Below half the period no picture can match two of the other side, so that the first one that
  // matches is the nearest.
  return std::min(asked_ns, (period_ns - 1) / 2);
}

StereoFrame Pairer::Join(FramePtr left, FramePtr right) {
  StereoFrame pair;
  pair.number = left->number;
  pair.skew_ns = right->capture_ns - left->capture_ns;
  stats_.left_alone = 0;
  stats_.right_alone = 0;
  stats_.by_trigger = CountTriggers(*left, *right);
  skews_ns_[stats_.pairs++ % kSkews] = pair.skew_ns < 0 ? -pair.skew_ns : pair.skew_ns;
  pair.left = std::move(left);
  pair.right = std::move(right);
  return pair;
}

PairStats Pairer::Stats() const {
  PairStats stats = stats_;
  stats.tolerance_ns = ToleranceNs();
  const size_t known = std::min<uint64_t>(stats.pairs, kSkews);
  if (known == 0) return stats;
  std::array<int64_t, kSkews> sorted = skews_ns_;
  std::sort(sorted.begin(), sorted.begin() + known);
  stats.skew_p50_ns = sorted[known / 2];
  stats.skew_p99_ns = sorted[known * 99 / 100];
  stats.skew_max_ns = sorted[known - 1];
  return stats;
}

}  // namespace vs
