#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>

#include "engine/base/clock.h"

namespace vs {

// A limit of time that several steps share: each gets what those before it have left.
class Deadline {
 public:
  // From now on. `clock` must outlive it.
  Deadline(const Clock& clock, std::chrono::nanoseconds limit)
      : clock_(clock), end_ns_(clock.MonotonicNs() + limit.count()) {}

  // Never negative, and rounded up: nothing is left only when it has passed.
  std::chrono::milliseconds Left() const {
    const std::chrono::nanoseconds left(std::max(int64_t{0}, end_ns_ - clock_.MonotonicNs()));
    return std::chrono::ceil<std::chrono::milliseconds>(left);
  }
  bool Passed() const { return clock_.MonotonicNs() >= end_ns_; }

 private:
  const Clock& clock_;
  const int64_t end_ns_;
};

}  // namespace vs
