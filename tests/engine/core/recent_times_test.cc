#include "engine/core/recent_times.h"

#include <gtest/gtest.h>

namespace vs {
namespace {

constexpr int64_t kMs = 1'000'000;

TEST(RecentTimes, KeepsTheLast256) {
  RecentTimes times;
  EXPECT_EQ(times.All(), std::vector<int64_t>{});
  for (int i = 1; i <= 300; ++i) times.Add(i);
  const std::vector<int64_t> all = times.All();
  EXPECT_EQ(all.size(), 256u);
  EXPECT_EQ(all.front(), 45);
  EXPECT_EQ(all.back(), 300);
}

TEST(Percentile, IsTheNearestRank) {
  EXPECT_EQ(Percentile({}, 50), 0);
  EXPECT_EQ(Percentile({7}, 99), 7);
  EXPECT_EQ(Percentile({4, 1, 3, 2}, 50), 2);
  std::vector<int64_t> hundred;
  for (int i = 100; i > 0; --i) hundred.push_back(i);
  EXPECT_EQ(Percentile(hundred, 99), 99);
  EXPECT_EQ(Percentile(hundred, 100), 100);
}

TEST(RatePerSecond, IsThatOfTheIntervals) {
  EXPECT_EQ(RatePerSecond({}, 5000 * kMs), 0);
  EXPECT_EQ(RatePerSecond({1000 * kMs, 1100 * kMs, 1200 * kMs}, 1250 * kMs), 10);
}

TEST(RatePerSecond, FallsWhenTheNextOneIsOverdueAndEndsAtNothing) {
  const std::vector<int64_t> times = {1000 * kMs, 1100 * kMs, 1200 * kMs};
  EXPECT_EQ(RatePerSecond(times, 2500 * kMs), 2) << "three in 1.5 s";
  EXPECT_EQ(RatePerSecond(times, 3150 * kMs), 0.5) << "one in two seconds";
  EXPECT_EQ(RatePerSecond(times, 9000 * kMs), 0);
}

}  // namespace
}  // namespace vs
