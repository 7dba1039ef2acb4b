#include "server/services/shared_observations.h"

#include <gtest/gtest.h>

#include "tests/support/fake_clock.h"

namespace vs {
namespace {

using std::chrono::milliseconds;

TEST(SharedObservations, AreLookedAtOnceForAllWatchers) {
  test::FakeClock clock;
  int looks = 0;
  SharedObservations observations(clock, [&] {
    return SharedObservations::List{{.id = "camera", .changes = std::to_string(++looks)}};
  });
  for (int watcher = 0; watcher < 50; ++watcher) {
    EXPECT_EQ(observations.Get()->at(0).changes, "1");
  }
  clock.Advance(milliseconds(99));
  EXPECT_EQ(observations.Get()->at(0).changes, "1");
  clock.Advance(milliseconds(1));
  EXPECT_EQ(observations.Get()->at(0).changes, "2");
}

TEST(SharedObservations, AreLookedAtAgainAfterAChange) {
  test::FakeClock clock;
  int looks = 0;
  SharedObservations observations(clock, [&] {
    ++looks;
    return SharedObservations::List();
  });
  observations.Get();
  observations.Renew();
  observations.Get();
  EXPECT_EQ(looks, 2);
}

}  // namespace
}  // namespace vs
