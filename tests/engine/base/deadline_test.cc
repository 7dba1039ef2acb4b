#include "engine/base/deadline.h"

#include <gtest/gtest.h>

#include "tests/support/fake_clock.h"

namespace vs {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

TEST(Deadline, LeavesToEachStepWhatTheOthersLeft) {
  test::FakeClock clock;
  const Deadline end(clock, std::chrono::seconds(9));
  EXPECT_EQ(end.Left(), milliseconds(9000));
  clock.Advance(milliseconds(2500));
  EXPECT_EQ(end.Left(), milliseconds(6500));
  EXPECT_FALSE(end.Passed());
  clock.Advance(milliseconds(9000));
  EXPECT_EQ(end.Left(), milliseconds(0));
  EXPECT_TRUE(end.Passed());
}

TEST(Deadline, HasSomethingLeftUntilItPasses) {
  test::FakeClock clock;
  const Deadline end(clock, milliseconds(1));
  clock.Advance(microseconds(999));
  EXPECT_EQ(end.Left(), milliseconds(1));
  clock.Advance(microseconds(1));
  EXPECT_EQ(end.Left(), milliseconds(0));
}

}  // namespace
}  // namespace vs
