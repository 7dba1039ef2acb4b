#include "server/services/periodic_source.h"

#include <algorithm>
#include <utility>

#include "engine/base/str.h"

namespace vs {
namespace {

constexpr uint32_t kMinIntervalMs = 100;
constexpr uint32_t kMaxIntervalMs = 60'000;
constexpr uint32_t kDefaultIntervalMs = 1000;
constexpr int64_t kNsPerMs = 1'000'000;
// Changes that nobody announces are found after this time.
constexpr int64_t kLookNs = 100 * kNsPerMs;

}  // namespace

Result<std::unique_ptr<StreamSource>> PeriodicSource::Make(uint32_t interval_ms, Look look,
                                                           Listen listen) {
  if (interval_ms == 0) interval_ms = kDefaultIntervalMs;
  if (interval_ms < kMinIntervalMs || interval_ms > kMaxIntervalMs) {
    return InvalidArgument(Str("interval_ms must be ", kMinIntervalMs, " to ", kMaxIntervalMs,
                               ", or 0 for ", kDefaultIntervalMs, ", not ", interval_ms));
  }
  return std::make_unique<PeriodicSource>(interval_ms * kNsPerMs, std::move(look),
                                          std::move(listen));
}

PeriodicSource::PeriodicSource(int64_t interval_ns, Look look, Listen listen)
    : interval_ns_(interval_ns), look_(std::move(look)), listen_(std::move(listen)) {}

void PeriodicSource::Start(std::function<void()> wake) {
  if (listen_) listening_ = listen_(std::move(wake));
}

StreamStep PeriodicSource::Next() {
  const int64_t now_ns = clock_.MonotonicNs();
  if (ready_.empty()) {
    const bool due = now_ns >= next_report_ns_;
    if (due) next_report_ns_ = now_ns + interval_ns_;
    for (Observation& one : look_()) {
      std::string& reported = reported_[one.id];
      if (!due && reported == one.changes) continue;
      reported = std::move(one.changes);
      ready_.push_back(std::move(one.message));
    }
  }
  if (ready_.empty()) return StreamStep::Wait(std::min(next_report_ns_, now_ns + kLookNs));
  StreamStep step = StreamStep::Message(std::move(ready_.front()));
  ready_.pop_front();
  return step;
}

}  // namespace vs
