#pragma once

#include <cstdint>

namespace vs::sim {

// The clock inside a simulated camera: it counts ticks of the host's monotonic clock, from another
// zero and at a slightly wrong rate if asked to.
struct DeviceClock {
  int64_t tick_hz = 1'000'000'000;
  int64_t offset_ns = 0;
  double drift_ppm = 0;  // positive: the camera's clock runs fast

  // What the camera's counter shows at an instant of the host's monotonic clock.
  uint64_t TicksAt(int64_t instant_ns) const;
  // The instant of a count; TicksAt and back loses less than one tick.
  int64_t InstantOfTicks(uint64_t ticks) const;
  // The instant whose scene a frame shows, from its timestamp in nanoseconds as a GigE Vision
  // client computes it: ticks * 1e9 / tick_hz, rounded down. A camera takes its picture of exactly
  // this instant, so the truth of a received frame is found from its timestamp alone:
  //   truth_renderer.At(clock.InstantOf(frame.timestamp_ns), pool)
  int64_t InstantOf(int64_t timestamp_ns) const;
};

}  // namespace vs::sim
