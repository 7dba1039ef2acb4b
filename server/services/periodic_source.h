#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "engine/base/clock.h"
#include "engine/base/status.h"
#include "server/rpc/stream_source.h"
#include "server/services/shared_observations.h"

namespace vs {

// A stream that reports on things at a fixed interval, and at once when one changes. One that
// reports on a single thing ends with NOT_FOUND when that goes.
class PeriodicSource final : public StreamSource {
 public:
  // Calls its argument when there may be something to see, until the returned handle goes.
  using Listen = std::function<std::shared_ptr<void>(std::function<void()>)>;

  struct Options {
    uint32_t interval_ms = 0;  // as in the request: 100..60000, 0 for 1000; else INVALID_ARGUMENT
    std::string id;            // only the thing of this id, which is there; empty for all
    // May be null: then changes are looked for ten times a second.
    Listen listen;
  };

  // `things` must outlive it.
  static Result<std::unique_ptr<StreamSource>> Make(SharedObservations& things, Options options);

  PeriodicSource(SharedObservations& things, int64_t interval_ns, Options options);

  void Start(std::function<void()> wake) override;
  StreamStep Next() override;

 private:
  SharedObservations& things_;
  const int64_t interval_ns_;
  const Options options_;
  const SystemClock clock_;
  std::shared_ptr<void> listening_;
  std::deque<WireMessage> ready_;
  std::map<std::string, std::string> reported_;  // `changes` by id
  int64_t next_report_ns_ = 0;
};

}  // namespace vs
