#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/clock.h"
#include "engine/base/mutex.h"
#include "server/rpc/wire_message.h"

namespace vs {

// One of the things that watchers are told about.
struct Observation {
  std::string id;       // of the thing
  std::string changes;  // reported at once when this differs from the last report
  WireMessage message;
};

// Things that any number of clients watch, looked at once for all of them. Thread-safe.
class SharedObservations {
 public:
  using List = std::vector<Observation>;
  using Look = std::function<List()>;

  // What is given out is never older than this.
  static constexpr int64_t kMaxAgeNs = 100'000'000;

  // `clock` must outlive it.
  SharedObservations(const Clock& clock, Look look) : clock_(clock), look_(std::move(look)) {}

  std::shared_ptr<const List> Get() VS_EXCLUDES(mutex_);
  // Something has changed: the next Get looks again.
  void Renew() VS_EXCLUDES(mutex_);

 private:
  const Clock& clock_;
  const Look look_;
  Mutex mutex_;
  std::shared_ptr<const List> last_ VS_GUARDED_BY(mutex_);
  int64_t looked_ns_ VS_GUARDED_BY(mutex_) = 0;
};

}  // namespace vs
