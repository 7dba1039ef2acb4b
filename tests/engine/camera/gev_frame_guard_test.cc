#include "engine/camera/gev_frame_guard.h"

#include <gtest/gtest.h>

#include <random>

namespace vs {
namespace {

constexpr int64_t kPeriodNs = 33'333'333;

TEST(GevFrameGuard, NumbersFramesFromOneAndCountsGaps) {
  GevFrameGuard guard;
  EXPECT_EQ(guard.Check(500, 1000).number, 1u);
  EXPECT_EQ(guard.Check(501, 2000).number, 2u);
  const auto verdict = guard.Check(505, 3000);
  EXPECT_TRUE(verdict.fresh);
  EXPECT_EQ(verdict.number, 6u);
  EXPECT_EQ(verdict.lost, 3u);
}

TEST(GevFrameGuard, FollowsTheWrapThatSkipsZero) {
  GevFrameGuard guard;
  guard.Check(65534, 1000);
  EXPECT_EQ(guard.Check(65535, 2000).lost, 0u);
  const auto wrapped = guard.Check(1, 3000);
  EXPECT_TRUE(wrapped.fresh);
  EXPECT_EQ(wrapped.lost, 0u);
  EXPECT_EQ(wrapped.number, 3u);
}

TEST(GevFrameGuard, CountsOnPast16Bits) {
  GevFrameGuard guard;
  guard.Check(65535, 1000);
  EXPECT_EQ(guard.Check(65536, 2000).lost, 0u);
  EXPECT_EQ(guard.Check(65540, 3000).lost, 3u);
  EXPECT_FALSE(guard.Check(65539, 4000).fresh);
}

TEST(GevFrameGuard, RefusesWhatWasSeenBefore) {
  GevFrameGuard guard;
  guard.Check(10, 1000);
  guard.Check(11, 2000);
  EXPECT_FALSE(guard.Check(11, 2000).fresh);
  EXPECT_FALSE(guard.Check(10, 1000).fresh);
  EXPECT_FALSE(guard.Check(0, 9000).fresh);
  EXPECT_EQ(guard.Check(12, 3000).number, 3u);
}

TEST(GevFrameGuard, RefusesANewIdWithAnOldTime) {
  GevFrameGuard guard;
  guard.Check(10, 1000);
  EXPECT_FALSE(guard.Check(11, 1000).fresh);
  EXPECT_FALSE(guard.Check(12, 500).fresh);
  EXPECT_EQ(guard.Check(13, 1500).number, 4u);
}

TEST(GevFrameGuard, AcceptsAClockThatWasSetBackFromTheSecondFrameOn) {
  GevFrameGuard guard;
  guard.Check(10, 1'000'000);
  EXPECT_FALSE(guard.Check(11, 100).fresh);
  const auto verdict = guard.Check(12, 200);
  EXPECT_TRUE(verdict.fresh);
  EXPECT_TRUE(verdict.clock_restarted);
  EXPECT_FALSE(guard.Check(13, 300).clock_restarted);
}

TEST(GevFrameGuard, KeepsNumberingAfterAReconnect) {
  GevFrameGuard guard;
  guard.Check(100, 1'000'000);
  guard.Restart();
  const auto verdict = guard.Check(1, 50);
  EXPECT_TRUE(verdict.fresh);
  EXPECT_EQ(verdict.number, 2u);
  EXPECT_EQ(verdict.lost, 0u);
}

TEST(GevFrameGuard, TakesIdsAloneFromACameraWithoutAClock) {
  GevFrameGuard guard;
  EXPECT_TRUE(guard.Check(1, 0).fresh);
  EXPECT_TRUE(guard.Check(2, 0).fresh);
  EXPECT_FALSE(guard.Check(2, 0).fresh);
}

class GevFrameGuardFuzz : public testing::TestWithParam<uint32_t> {};

// Random losses and replays of old buffers over several wraps: the numbers given are exactly those
// of a counter that never wraps.
TEST_P(GevFrameGuardFuzz, NeverLetsAnOldFramePassAndNeverMiscounts) {
  std::mt19937 random(GetParam());
  GevFrameGuard guard;
  uint64_t truth = 0;
  uint64_t lost = 0;
  const uint64_t first_id = random() % 65535;
  for (int i = 0; i < 200'000; ++i) {
    truth += random() % 50 == 0 ? 1 + random() % 2000 : 1;
    const auto verdict =
        guard.Check((first_id + truth) % 65535 + 1, static_cast<int64_t>(truth) * kPeriodNs);
    ASSERT_TRUE(verdict.fresh);
    if (i == 0) truth = 1;
    lost += verdict.lost;
    ASSERT_EQ(verdict.number, truth);
    if (random() % 10 == 0) {
      const uint64_t age = random() % 16;
      if (age >= truth) continue;
      ASSERT_FALSE(guard
                       .Check((first_id + truth - age) % 65535 + 1,
                              static_cast<int64_t>(truth - age) * kPeriodNs)
                       .fresh);
    }
  }
  EXPECT_EQ(lost + 200'000, truth);
}

INSTANTIATE_TEST_SUITE_P(Seeds, GevFrameGuardFuzz, testing::Range(1u, 5u));

}  // namespace
}  // namespace vs
