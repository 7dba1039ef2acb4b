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

}  // namespace

Result<std::unique_ptr<StreamSource>> PeriodicSource::Make(SharedObservations& things,
                                                           Options options) {
  const uint32_t interval_ms = options.interval_ms == 0 ? kDefaultIntervalMs : options.interval_ms;
  if (interval_ms < kMinIntervalMs || interval_ms > kMaxIntervalMs) {
    return InvalidArgument(Str("interval_ms must be ", kMinIntervalMs, " to ", kMaxIntervalMs,
                               ", or 0 for ", kDefaultIntervalMs, ", not ", interval_ms));
  }
  return std::make_unique<PeriodicSource>(things, interval_ms * kNsPerMs, std::move(options));
}

PeriodicSource::PeriodicSource(SharedObservations& things, int64_t interval_ns, Options options)
    : things_(things), interval_ns_(interval_ns), options_(std::move(options)) {}

void PeriodicSource::Start(std::function<void()> wake) {
  if (options_.listen) listening_ = options_.listen(std::move(wake));
}

StreamStep PeriodicSource::Next() {
  const int64_t now_ns = clock_.MonotonicNs();
  if (ready_.empty()) {
    const bool due = now_ns >= next_report_ns_;
    if (due) next_report_ns_ = now_ns + interval_ns_;
    bool found = options_.id.empty();
    for (const Observation& one : *things_.Get()) {
      if (!options_.id.empty() && one.id != options_.id) continue;
      found = true;
      std::string& reported = reported_[one.id];
      if (!due && reported == one.changes) continue;
      reported = one.changes;
      ready_.push_back(one.message);
    }
    if (!found)
      return StreamStep::End(NotFound(Str(Quoted(options_.id), " is not there any more")));
  }
  if (ready_.empty()) {
    // Changes that nobody announces are found then.
    return StreamStep::Wait(std::min(next_report_ns_, now_ns + SharedObservations::kMaxAgeNs));
  }
  StreamStep step = StreamStep::Message(std::move(ready_.front()));
  ready_.pop_front();
  return step;
}

}  // namespace vs
