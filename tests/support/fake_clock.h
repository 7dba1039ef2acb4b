#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>

#include "engine/base/clock.h"

namespace vs::test {

// A clock that stands still until a test moves it. Thread-safe.
class FakeClock final : public Clock {
 public:
  int64_t MonotonicNs() const override { return monotonic_ns_; }
  int64_t UtcNs() const override { return utc_ns_; }

  void Advance(std::chrono::nanoseconds time) {
    monotonic_ns_ += time.count();
    utc_ns_ += time.count();
  }
  // As somebody does who sets the machine's time.
  void SetUtcBack(std::chrono::nanoseconds time) { utc_ns_ -= time.count(); }

 private:
  std::atomic<int64_t> monotonic_ns_{1'000'000'000'000};
  std::atomic<int64_t> utc_ns_{1'700'000'000'000'000'000};  // 2023-11-14
};

}  // namespace vs::test
