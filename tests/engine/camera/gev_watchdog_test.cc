#include "engine/camera/gev_watchdog.h"

#include <gtest/gtest.h>

namespace vs {
namespace {

using Action = GevWatchdog::Action;

constexpr int64_t kMs = 1'000'000;
constexpr int64_t kPeriodNs = 33 * kMs;

// A free-running camera that has just delivered a picture at time 0.
GevWatchdog Streaming() {
  GevWatchdog watchdog;
  watchdog.Restart(-2000 * kMs, false, 0);
  watchdog.Picture(0, kPeriodNs);
  return watchdog;
}

TEST(GevWatchdog, StallsAfter200MsWithoutAPicture) {
  GevWatchdog watchdog = Streaming();
  EXPECT_EQ(watchdog.Check(199 * kMs), Action::kNone);
  EXPECT_FALSE(watchdog.stalled());
  EXPECT_EQ(watchdog.Check(200 * kMs), Action::kAsk);
  EXPECT_TRUE(watchdog.stalled());
}

TEST(GevWatchdog, WaitsThreePeriodsForASlowCamera) {
  GevWatchdog watchdog = Streaming();
  watchdog.Picture(0, 500 * kMs);
  EXPECT_EQ(watchdog.Check(1499 * kMs), Action::kNone);
  EXPECT_EQ(watchdog.Check(1500 * kMs), Action::kAsk);
}

TEST(GevWatchdog, GivesTheFirstPictureASecond) {
  GevWatchdog watchdog;
  watchdog.Restart(0, false, 0);
  EXPECT_EQ(watchdog.Check(999 * kMs), Action::kNone);
  EXPECT_EQ(watchdog.Check(1000 * kMs), Action::kAsk);
}

TEST(GevWatchdog, BelievesACameraThatSaysItIsSlow) {
  GevWatchdog watchdog;
  watchdog.Restart(0, false, 10'000 * kMs);
  EXPECT_EQ(watchdog.Check(29'999 * kMs), Action::kNone);
  EXPECT_EQ(watchdog.Check(30'000 * kMs), Action::kAsk);
}

TEST(GevWatchdog, RecoversWithTheNextPicture) {
  GevWatchdog watchdog = Streaming();
  watchdog.Check(200 * kMs);
  watchdog.NotAnswered(200 * kMs);
  watchdog.Picture(300 * kMs, kPeriodNs);
  EXPECT_FALSE(watchdog.stalled());
  EXPECT_EQ(watchdog.Check(499 * kMs), Action::kNone);
}

TEST(GevWatchdog, AsksFiveTimesASecondAndGivesUpAfterOneAndAHalf) {
  GevWatchdog watchdog = Streaming();
  int asked = 0;
  int64_t now_ms = 200;
  while (watchdog.Check(now_ms * kMs) != Action::kLostSilent) {
    if (now_ms % 200 == 0) {
      ++asked;
      watchdog.NotAnswered(now_ms * kMs);
    }
    now_ms += 10;
    ASSERT_LT(now_ms, 10'000);
  }
  EXPECT_EQ(now_ms, 1700);
  EXPECT_EQ(asked, 8);
}

TEST(GevWatchdog, GivesUpACameraThatAnswersButSendsNothing) {
  GevWatchdog watchdog = Streaming();
  for (int64_t now_ms = 200; now_ms < 5200; now_ms += 10) {
    ASSERT_NE(watchdog.Check(now_ms * kMs), Action::kLostIdle);
    watchdog.Answered(now_ms * kMs);
  }
  EXPECT_EQ(watchdog.Check(5200 * kMs), Action::kLostIdle);
}

TEST(GevWatchdog, LetsATriggeredCameraBeSilentAsLongAsItAnswers) {
  GevWatchdog watchdog;
  watchdog.Restart(0, true, 0);
  for (int64_t now_ms = 0; now_ms < 60'000; now_ms += 10) {
    const Action action = watchdog.Check(now_ms * kMs);
    ASSERT_TRUE(action == Action::kNone || action == Action::kAsk);
    if (action == Action::kAsk) watchdog.Answered(now_ms * kMs);
    ASSERT_FALSE(watchdog.stalled());
  }
  EXPECT_EQ(watchdog.Check(60'000 * kMs), Action::kAsk);
  watchdog.NotAnswered(60'000 * kMs);
  EXPECT_TRUE(watchdog.stalled());
  EXPECT_EQ(watchdog.Check(61'500 * kMs), Action::kLostSilent);
}

TEST(GevWatchdog, DoesNotBlameTheCameraForMissingBuffers) {
  GevWatchdog watchdog = Streaming();
  for (int64_t now_ms = 0; now_ms < 60'000; now_ms += 10) {
    watchdog.Starving(now_ms * kMs);
    ASSERT_EQ(watchdog.Check(now_ms * kMs), Action::kNone);
  }
}

}  // namespace
}  // namespace vs
