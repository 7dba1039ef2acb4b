#pragma once

#include <cstdint>

namespace vs {

// Where time comes from. Injected, so that tests set it; thread-safe.
class Clock {
 public:
  virtual ~Clock() = default;
  // Nanoseconds of a clock that never jumps; its zero means nothing. For durations and order.
  virtual int64_t MonotonicNs() const = 0;
  // Nanoseconds since 1970-01-01 UTC. For people and records.
  virtual int64_t UtcNs() const = 0;
};

// The machine's clock (CLOCK_MONOTONIC and CLOCK_REALTIME).
class SystemClock final : public Clock {
 public:
  int64_t MonotonicNs() const override;
  int64_t UtcNs() const override;
};

}  // namespace vs
