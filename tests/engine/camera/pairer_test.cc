#include "engine/camera/pairer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <iterator>
#include <random>
#include <set>

namespace vs {
namespace {

constexpr int64_t kMs = 1'000'000;
constexpr int64_t kPeriodNs = 33'333'333;

FramePtr MakeFrame(uint64_t number, int64_t capture_ns, uint64_t trigger = 0) {
  auto frame = std::make_shared<Frame>();
  frame->number = number;
  frame->trigger = trigger;
  frame->capture_ns = capture_ns;
  return frame;
}

TEST(Pairer, JoinsPicturesOfTheSameInstant) {
  Pairer pairer;
  EXPECT_FALSE(pairer.Add(Side::kRight, MakeFrame(9, 1000 * kMs)));
  const auto pair = pairer.Add(Side::kLeft, MakeFrame(5, 1001 * kMs));
  ASSERT_TRUE(pair);
  EXPECT_EQ(pair->left->number, 5u);
  EXPECT_EQ(pair->right->number, 9u);
  EXPECT_EQ(pair->number, 5u);
  EXPECT_EQ(pair->skew_ns, -1 * kMs);
}

TEST(Pairer, LetsThePictureWithoutACounterpartGo) {
  Pairer pairer;
  pairer.Add(Side::kLeft, MakeFrame(1, 0));
  pairer.Add(Side::kLeft, MakeFrame(2, kPeriodNs));
  const auto pair = pairer.Add(Side::kRight, MakeFrame(1, kPeriodNs + kMs));
  ASSERT_TRUE(pair);
  EXPECT_EQ(pair->left->number, 2u);
  EXPECT_EQ(pairer.Stats().left, (Unpaired{.no_counterpart = 1}));
  EXPECT_EQ(pairer.Stats().right, Unpaired{});
}

TEST(Pairer, CountsTheNewPictureWhenItsCounterpartWasLost) {
  Pairer pairer;
  pairer.Add(Side::kLeft, MakeFrame(2, kPeriodNs));
  EXPECT_FALSE(pairer.Add(Side::kRight, MakeFrame(1, 0)));
  EXPECT_EQ(pairer.Stats().right, (Unpaired{.no_counterpart = 1}));
  EXPECT_TRUE(pairer.Add(Side::kRight, MakeFrame(2, kPeriodNs)));
}

TEST(Pairer, PrefersTheTriggerNumberToTime) {
  Pairer pairer;
  pairer.Add(Side::kLeft, MakeFrame(1, 0, 7));
  pairer.Add(Side::kLeft, MakeFrame(2, kPeriodNs, 8));
  const auto pair = pairer.Add(Side::kRight, MakeFrame(1, 20 * kPeriodNs, 8));
  ASSERT_TRUE(pair);
  EXPECT_EQ(pair->left->number, 2u);
  EXPECT_TRUE(pairer.Stats().by_trigger);
}

TEST(Pairer, UsesTimeWhenOnlyOneCameraCountsTriggers) {
  Pairer pairer;
  pairer.Add(Side::kLeft, MakeFrame(1, 0, 7));
  EXPECT_TRUE(pairer.Add(Side::kRight, MakeFrame(1, kMs)));
  EXPECT_FALSE(pairer.Stats().by_trigger);
}

TEST(Pairer, KeepsAtMostFourPicturesOfASilentCounterpart) {
  Pairer pairer;
  for (int i = 0; i < 10; ++i) pairer.Add(Side::kLeft, MakeFrame(i + 1, i * kPeriodNs));
  EXPECT_EQ(pairer.Waiting(Side::kLeft), 4u);
  EXPECT_EQ(pairer.Stats().left, (Unpaired{.overflow = 6}));
}

TEST(Pairer, RefusesAPictureThatIsOlderThanItsPredecessorAndGoesOn) {
  Pairer pairer;
  pairer.Add(Side::kLeft, MakeFrame(1, 10 * kPeriodNs));
  pairer.Add(Side::kLeft, MakeFrame(2, 3 * kPeriodNs));
  EXPECT_EQ(pairer.Stats().left, (Unpaired{.out_of_order = 1}));
  pairer.Add(Side::kLeft, MakeFrame(3, 11 * kPeriodNs));
  EXPECT_EQ(pairer.Stats().left, (Unpaired{.out_of_order = 1}));
  EXPECT_TRUE(pairer.Add(Side::kRight, MakeFrame(1, 10 * kPeriodNs)));
}

TEST(Pairer, DerivesTheToleranceFromThePictureRate) {
  Pairer slow;
  slow.Add(Side::kLeft, MakeFrame(1, 0));
  slow.Add(Side::kLeft, MakeFrame(2, 100 * kMs));
  EXPECT_EQ(slow.Stats().tolerance_ns, 5 * kMs);
  Pairer fast;
  fast.Add(Side::kLeft, MakeFrame(1, 0));
  fast.Add(Side::kLeft, MakeFrame(2, 8 * kMs));
  EXPECT_EQ(fast.Stats().tolerance_ns, 2 * kMs);
}

TEST(Pairer, TakesTheGivenToleranceOnlyUpToHalfThePicturePeriod) {
  Pairer pairer({.tolerance_ns = 40 * kMs});
  EXPECT_EQ(pairer.Stats().tolerance_ns, 5 * kMs) << "while the period is unknown";
  pairer.Add(Side::kLeft, MakeFrame(1, 0));
  pairer.Add(Side::kLeft, MakeFrame(2, 60 * kMs));
  EXPECT_EQ(pairer.Stats().tolerance_ns, 30 * kMs - 1);
  pairer.Add(Side::kLeft, MakeFrame(3, 160 * kMs));
  EXPECT_EQ(pairer.Stats().tolerance_ns, 30 * kMs - 1) << "the shortest interval counts";
  Pairer narrow({.tolerance_ns = 7 * kMs});
  narrow.Add(Side::kLeft, MakeFrame(1, 0));
  narrow.Add(Side::kLeft, MakeFrame(2, kPeriodNs));
  EXPECT_EQ(narrow.Stats().tolerance_ns, 7 * kMs);
}

TEST(Pairer, StaysRightAfterALossWithAToleranceLongerThanThePeriod) {
  Pairer pairer({.tolerance_ns = 40 * kMs});
  for (uint64_t number = 1; number <= 10; ++number) {
    const int64_t instant_ns = static_cast<int64_t>(number) * kPeriodNs;
    pairer.Add(Side::kLeft, MakeFrame(number, instant_ns));
    if (number == 2) continue;  // lost on the way
    const auto pair = pairer.Add(Side::kRight, MakeFrame(number, instant_ns));
    ASSERT_TRUE(pair) << number;
    EXPECT_EQ(pair->left->number, number);
  }
  EXPECT_EQ(pairer.Stats().left, (Unpaired{.no_counterpart = 1}));
}

TEST(Pairer, TellsTheSkew) {
  Pairer pairer;
  for (int i = 0; i < 100; ++i) {
    pairer.Add(Side::kLeft, MakeFrame(i + 1, i * kPeriodNs));
    pairer.Add(Side::kRight, MakeFrame(i + 1, i * kPeriodNs - (i == 50 ? 4 : 1) * kMs));
  }
  EXPECT_EQ(pairer.Stats().pairs, 100u);
  EXPECT_EQ(pairer.Stats().skew_p50_ns, 1 * kMs);
  EXPECT_EQ(pairer.Stats().skew_p99_ns, 4 * kMs);
  EXPECT_EQ(pairer.Stats().skew_max_ns, 4 * kMs);
}

// One rig with random losses on both sides, jitter, and the right clock a little off and drifting.
// The truth of each picture is its trigger index, which the pairer does not see (number).
struct Rig {
  explicit Rig(uint32_t seed) : random(seed) {}
  bool Chance(double p) { return std::uniform_real_distribution<>(0, 1)(random) < p; }
  int64_t Jitter() { return std::uniform_int_distribution<int64_t>(-kMs / 2, kMs / 2)(random); }

  std::mt19937 random;
};

class PairerFuzz : public testing::TestWithParam<uint32_t> {};

TEST_P(PairerFuzz, NeverMakesAWrongPairAndCountsEveryPicture) {
  Rig rig(GetParam());
  const bool count_triggers = rig.Chance(0.5);
  const double loss = 0.3 * (GetParam() % 4) / 3.0;
  const int64_t clock_error_ns = rig.Jitter();
  // Automatic, narrow, longer than the picture period, and as long as a user can ask for.
  constexpr int64_t kTolerancesNs[] = {0, 5 * kMs, 40 * kMs, 1000 * kMs};
  Pairer pairer({.tolerance_ns = kTolerancesNs[GetParam() / 4 % 4]});
  std::array<std::deque<FramePtr>, 2> network;  // under way to the host, in order per camera
  std::array<std::set<uint64_t>, 2> delivered;
  std::set<uint64_t> paired;
  constexpr uint64_t kTriggers = 3000;
  uint64_t trigger = 0;
  while (trigger < kTriggers || !network[0].empty() || !network[1].empty()) {
    if (trigger < kTriggers && rig.Chance(0.5)) {
      ++trigger;
      const int64_t instant_ns = static_cast<int64_t>(trigger) * kPeriodNs;
      for (size_t side = 0; side < 2; ++side) {
        if (rig.Chance(loss)) continue;
        const int64_t drift_ns = side == 1 ? clock_error_ns + instant_ns / 1'000'000 * 10 : 0;
        network[side].push_back(
            MakeFrame(trigger, instant_ns + rig.Jitter() + drift_ns, count_triggers ? trigger : 0));
      }
    }
    const size_t side = rig.Chance(0.5) ? 1 : 0;
    // The two links differ by at most the depth of the queues.
    if (network[side].empty() || network[side].size() + 3 < network[1 - side].size()) continue;
    const FramePtr frame = network[side].front();
    network[side].pop_front();
    delivered[side].insert(frame->number);
    if (const auto pair = pairer.Add(static_cast<Side>(side), frame)) {
      ASSERT_EQ(pair->left->number, pair->right->number);
      ASSERT_TRUE(paired.insert(pair->number).second) << "the same picture twice";
    }
  }
  const PairStats stats = pairer.Stats();
  EXPECT_EQ(stats.pairs, paired.size());
  EXPECT_EQ(delivered[0].size(), stats.pairs + stats.left.Total() + pairer.Waiting(Side::kLeft));
  EXPECT_EQ(delivered[1].size(), stats.pairs + stats.right.Total() + pairer.Waiting(Side::kRight));
  EXPECT_EQ(stats.left.out_of_order + stats.right.out_of_order, 0u);
  // Nothing is lost by the pairer itself: every complete pair was found unless a queue overflowed.
  std::set<uint64_t> complete;
  std::ranges::set_intersection(delivered[0], delivered[1],
                                std::inserter(complete, complete.end()));
  EXPECT_GE(paired.size() + stats.left.overflow + stats.right.overflow, complete.size());
  EXPECT_GT(paired.size(), kTriggers / 3);
}

INSTANTIATE_TEST_SUITE_P(Seeds, PairerFuzz, testing::Range(1u, 81u));

}  // namespace
}  // namespace vs
