#include "engine/camera/clock_mapper.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <random>

namespace vs {
namespace {

constexpr int64_t kMs = 1'000'000;
constexpr int64_t kSecond = 1'000'000'000;

TEST(ClockMapper, TakesTheSmallestDelayAsTheOffset) {
  ClockMapper mapper;
  EXPECT_FALSE(mapper.known());
  EXPECT_EQ(mapper.HostNs(5), 0);
  mapper.Add(100, 100 + kSecond + 30 * kMs);
  mapper.Add(200, 200 + kSecond + 2 * kMs);
  mapper.Add(300, 300 + kSecond + 50 * kMs);
  EXPECT_NEAR(mapper.HostNs(1000), 1000 + kSecond + 2 * kMs, static_cast<double>(kMs) / 100);
}

TEST(ClockMapper, StartsAnewAfterAReset) {
  ClockMapper mapper;
  mapper.Add(0, kSecond);
  mapper.Reset();
  EXPECT_FALSE(mapper.known());
  mapper.Add(0, 7 * kSecond);
  EXPECT_EQ(mapper.HostNs(1), 7 * kSecond + 1);
}

struct Drift {
  double ppm;
  int64_t offset_ns;
};

class ClockMapperDrift : public testing::TestWithParam<Drift> {};

// Ten minutes of pictures at 30 fps, delayed by at least 0.1 ms and now and then by up to 80 ms.
TEST_P(ClockMapperDrift, StaysWithinAMillisecond) {
  std::mt19937 random(1);
  std::exponential_distribution<> delay_ms(1.0);
  ClockMapper mapper;
  int64_t worst_ns = 0;
  for (int i = 0; i < 18'000; ++i) {
    const int64_t host_ns = 50 * kSecond + i * (kSecond / 30);
    const auto device_ns =
        static_cast<int64_t>(static_cast<double>(host_ns) * (1 + GetParam().ppm * 1e-6)) +
        GetParam().offset_ns;
    const double busy_ms = i % 100 < 10 ? 70 : 0;
    const auto delay_ns = static_cast<int64_t>((0.1 + busy_ms + delay_ms(random)) * 1e6);
    mapper.Add(device_ns, host_ns + delay_ns);
    if (i > 100) worst_ns = std::max(worst_ns, std::abs(mapper.HostNs(device_ns) - host_ns));
  }
  EXPECT_LT(worst_ns, kMs);
}

INSTANTIATE_TEST_SUITE_P(Clocks, ClockMapperDrift,
                         testing::Values(Drift{0, 0}, Drift{100, 3 * kSecond},
                                         Drift{-100, -40 * kSecond}, Drift{190, 0},
                                         Drift{-190, 0}));

}  // namespace
}  // namespace vs
