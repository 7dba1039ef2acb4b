#pragma once

#include <atomic>
#include <cstdint>
#include <string_view>

#include "engine/base/mutex.h"
#include "engine/base/status.h"

namespace vs::sim {

// What a simulated camera does wrong on purpose.
struct FaultSettings {
  double drop_packets = 0;       // probability, each time a packet is sent
  double duplicate_packets = 0;  // probability
  double reorder_packets = 0;    // probability that a packet changes places with the next
  double drop_frames = 0;        // probability that a frame is taken but never sent
  int wrong_type = 0;            // payload type of every wrong_type_every-th frame
  int wrong_type_every = 0;      // 0 = never
  int64_t frozen_until_ns = 0;   // no pictures are taken before (monotonic clock)
  bool unplugged = false;        // nothing comes in and nothing goes out
  bool black = false;            // pictures are black
  int slow_answer_ms = 0;        // each GVCP answer is late
};

// The faults of one camera, set from the outside while it runs. Thread-safe.
class Faults {
 public:
  FaultSettings Get() const;
  // One of
  //   drop P | duplicate P | reorder P | drop-frames P     probabilities 0 .. 1
  //   payload-type TYPE EVERY                              0 0 ends it
  //   freeze SECONDS
  //   unplug | plug
  //   black on|off
  //   slow-answer MS
  //   clear                                                everything in order again
  // INVALID_ARGUMENT names what was expected.
  Status Apply(std::string_view command, int64_t now_ns);

  // True with the given probability; the same sequence in each run.
  bool Happens(double probability);

 private:
  mutable Mutex mutex_;
  FaultSettings settings_ VS_GUARDED_BY(mutex_);
  std::atomic<uint64_t> draws_ = 0;
};

}  // namespace vs::sim
