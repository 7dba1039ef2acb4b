#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/clock.h"
#include "engine/base/status.h"
#include "server/rpc/stream_source.h"

namespace vs {

// One of the things that a PeriodicSource reports on.
struct Observation {
  std::string id;       // of the thing
  std::string changes;  // reported at once when this differs from the last report
  WireMessage message;
};

// A stream that reports on things at a fixed interval, and at once when one changes.
class PeriodicSource final : public StreamSource {
 public:
  using Look = std::function<std::vector<Observation>()>;
  // Calls its argument when there may be something to see, until the returned handle goes.
  using Listen = std::function<std::shared_ptr<void>(std::function<void()>)>;

  // `interval_ms` as in the request: 100..60000, 0 for 1000; else INVALID_ARGUMENT. `listen` may be
  // null: then changes are looked for ten times a second.
  static Result<std::unique_ptr<StreamSource>> Make(uint32_t interval_ms, Look look, Listen listen);

  PeriodicSource(int64_t interval_ns, Look look, Listen listen);

  void Start(std::function<void()> wake) override;
  StreamStep Next() override;

 private:
  const int64_t interval_ns_;
  const Look look_;
  const Listen listen_;
  const SystemClock clock_;
  std::shared_ptr<void> listening_;
  std::deque<WireMessage> ready_;
  std::map<std::string, std::string> reported_;  // `changes` by id
  int64_t next_report_ns_ = 0;
};

}  // namespace vs
