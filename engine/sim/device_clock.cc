#include "engine/sim/device_clock.h"

#include <cmath>

namespace vs::sim {
namespace {

constexpr int64_t kNsPerSecond = 1'000'000'000;

// value * numerator / denominator, rounded down, for values whose product does not fit.
int64_t Scale(int64_t value, int64_t numerator, int64_t denominator) {
  const int64_t whole = value / denominator;
  const int64_t rest = value % denominator;
  return whole * numerator + rest * numerator / denominator;
}

}  // namespace

uint64_t DeviceClock::TicksAt(int64_t instant_ns) const {
  const auto drift_ns = static_cast<int64_t>(std::floor(instant_ns * (drift_ppm * 1e-6) + 0.5));
  return static_cast<uint64_t>(Scale(instant_ns + drift_ns + offset_ns, tick_hz, kNsPerSecond));
}

int64_t DeviceClock::InstantOfTicks(uint64_t ticks) const {
  const int64_t device_ns = Scale(static_cast<int64_t>(ticks), kNsPerSecond, tick_hz) - offset_ns;
  const double rate = drift_ppm * 1e-6;
  return device_ns - static_cast<int64_t>(std::floor(device_ns * (rate / (1 + rate)) + 0.5));
}

int64_t DeviceClock::InstantOf(int64_t timestamp_ns) const {
  // The count is the smallest one whose nanoseconds, rounded down, are not below the timestamp.
  int64_t ticks = Scale(timestamp_ns, tick_hz, kNsPerSecond);
  if (Scale(ticks, kNsPerSecond, tick_hz) < timestamp_ns) ++ticks;
  return InstantOfTicks(static_cast<uint64_t>(ticks));
}

}  // namespace vs::sim
