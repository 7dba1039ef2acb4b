#include "engine/camera/gev_watchdog.h"

#include <algorithm>

namespace vs {
namespace {

constexpr int64_t kMs = 1'000'000;
constexpr int64_t kShortestPatienceNs = 200 * kMs;
constexpr int64_t kFirstPicturePatienceNs = 1000 * kMs;
constexpr int64_t kTriggeredPatienceNs = 1000 * kMs;
constexpr int64_t kAskEveryNs = 200 * kMs;
constexpr int64_t kSilentUntilLostNs = 1500 * kMs;
constexpr int64_t kIdleUntilLostNs = 5000 * kMs;

}  // namespace

void GevWatchdog::Restart(int64_t now_ns, bool triggered, int64_t period_ns) {
  *this = GevWatchdog();
  triggered_ = triggered;
  period_ns_ = period_ns;
  quiet_until_ns_ = now_ns + std::max(kFirstPicturePatienceNs, 3 * period_ns);
}

void GevWatchdog::Picture(int64_t now_ns, int64_t period_ns) {
  period_ns_ = period_ns;
  stalled_ = false;
  answering_ = true;
  const int64_t patience_ns = std::max(kShortestPatienceNs, 3 * period_ns);
  quiet_until_ns_ =
      now_ns + (triggered_ ? std::max(patience_ns, kTriggeredPatienceNs) : patience_ns);
}

GevWatchdog::Action GevWatchdog::Check(int64_t now_ns) {
  if (now_ns < quiet_until_ns_) return Action::kNone;
  if (!triggered_) Stall(now_ns);
  const int64_t stalled_ns = stalled_ ? now_ns - stalled_since_ns_ : 0;
  if (!answering_ && stalled_ns >= kSilentUntilLostNs) return Action::kLostSilent;
  if (answering_ && stalled_ns >= kIdleUntilLostNs) return Action::kLostIdle;
  if (now_ns < ask_after_ns_) return Action::kNone;
  ask_after_ns_ = now_ns + kAskEveryNs;
  return Action::kAsk;
}

void GevWatchdog::Answered(int64_t now_ns) {
  answering_ = true;
  if (!triggered_) return;
  stalled_ = false;
  quiet_until_ns_ = now_ns + kTriggeredPatienceNs;
}

void GevWatchdog::NotAnswered(int64_t now_ns) {
  answering_ = false;
  Stall(now_ns);
}

void GevWatchdog::Stall(int64_t now_ns) {
  if (stalled_) return;
  stalled_ = true;
  stalled_since_ns_ = now_ns;
}

}  // namespace vs
