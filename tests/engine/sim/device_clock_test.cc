#include "engine/sim/device_clock.h"

#include <gtest/gtest.h>

namespace vs::sim {
namespace {

// As GigE Vision clients turn ticks into nanoseconds.
int64_t NanosecondsOf(const DeviceClock& clock, uint64_t ticks) {
  const auto hz = static_cast<uint64_t>(clock.tick_hz);
  return static_cast<int64_t>(ticks / hz * 1'000'000'000 + ticks % hz * 1'000'000'000 / hz);
}

TEST(DeviceClock, OfNanosecondsIsTheHostsClock) {
  EXPECT_EQ(DeviceClock().TicksAt(123'456'789'012'345), 123'456'789'012'345u);
  EXPECT_EQ(DeviceClock().InstantOf(123'456'789'012'345), 123'456'789'012'345);
}

TEST(DeviceClock, CountsTicksFromAnotherZero) {
  const DeviceClock clock = {.tick_hz = 125'000'000, .offset_ns = 3'000'000'000};
  EXPECT_EQ(clock.TicksAt(1'000'000'000), 500'000'000u);
  EXPECT_EQ(clock.InstantOfTicks(500'000'000), 1'000'000'000);
}

TEST(DeviceClock, GainsByItsDrift) {
  const DeviceClock clock = {.drift_ppm = 100};
  EXPECT_EQ(clock.TicksAt(10'000'000'000), 10'001'000'000u);
}

TEST(DeviceClock, FindsTheInstantOfATimestamp) {
  const DeviceClock clocks[] = {
      {},
      {.tick_hz = 125'000'000},
      {.tick_hz = 66'666'667, .offset_ns = -5'000'000'000, .drift_ppm = -37.5},
      {.tick_hz = 1000, .offset_ns = 77, .drift_ppm = 100},
  };
  for (const DeviceClock& clock : clocks) {
    for (int64_t instant = 1'000'000'000'000; instant < 1'000'000'100'000; instant += 7919) {
      const uint64_t ticks = clock.TicksAt(instant);
      const int64_t shown = clock.InstantOfTicks(ticks);
      EXPECT_EQ(clock.InstantOf(NanosecondsOf(clock, ticks)), shown);
      EXPECT_NEAR(static_cast<double>(shown - instant), 0,
                  1e9 / static_cast<double>(clock.tick_hz) + 3);
    }
  }
}

}  // namespace
}  // namespace vs::sim
