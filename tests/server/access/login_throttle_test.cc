#include "server/access/login_throttle.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/base/str.h"
#include "tests/support/fake_clock.h"

namespace vs {
namespace {

using std::chrono::milliseconds;
using std::chrono::minutes;
using std::chrono::seconds;
using ::testing::HasSubstr;

class LoginThrottleTest : public ::testing::Test {
 protected:
  void Fail(int times, const std::string& name, const std::string& address) {
    for (int i = 0; i < times; ++i) throttle_.Failed(name, address);
  }

  test::FakeClock clock_;
  LoginThrottle throttle_{clock_};
};

TEST_F(LoginThrottleTest, LetsAnAccountFailFourTimes) {
  Fail(4, "maria", "10.0.0.1");
  EXPECT_TRUE(throttle_.CheckAccount("maria").ok());
}

TEST_F(LoginThrottleTest, DoublesTheWaitFromTheFifthFailure) {
  Fail(5, "maria", "10.0.0.1");
  EXPECT_EQ(throttle_.CheckAccount("maria").code(), StatusCode::kResourceExhausted);
  EXPECT_THAT(throttle_.CheckAccount("maria").message(), HasSubstr("in 1 s"));
  clock_.Advance(milliseconds(1000));
  EXPECT_TRUE(throttle_.CheckAccount("maria").ok());

  Fail(1, "maria", "10.0.0.1");
  EXPECT_THAT(throttle_.CheckAccount("maria").message(), HasSubstr("in 2 s"));
  Fail(1, "maria", "10.0.0.1");
  EXPECT_THAT(throttle_.CheckAccount("maria").message(), HasSubstr("in 4 s"));
}

TEST_F(LoginThrottleTest, TellsUntilWhenAnAccountIsLocked) {
  Fail(4, "maria", "10.0.0.1");
  EXPECT_EQ(throttle_.LockedUntilUtcNs("maria"), 0);
  Fail(2, "maria", "10.0.0.1");
  EXPECT_EQ(throttle_.LockedUntilUtcNs("maria"), clock_.UtcNs() + 2'000'000'000);
  clock_.Advance(seconds(2));
  EXPECT_EQ(throttle_.LockedUntilUtcNs("maria"), 0);
  EXPECT_EQ(throttle_.LockedUntilUtcNs("nobody"), 0);
}

TEST_F(LoginThrottleTest, NeverWaitsLongerThanAQuarterOfAnHour) {
  for (int i = 0; i < 100; ++i) Fail(1, "maria", Str("10.0.0.", i));
  EXPECT_THAT(throttle_.CheckAccount("maria").message(), HasSubstr("in 900 s"));
  clock_.Advance(minutes(15));
  EXPECT_TRUE(throttle_.CheckAccount("maria").ok());
}

TEST_F(LoginThrottleTest, ForgetsFailuresWhenToldOrAfterAnHour) {
  Fail(5, "maria", "10.0.0.1");
  throttle_.Forget("maria");
  EXPECT_TRUE(throttle_.CheckAccount("maria").ok());

  Fail(5, "ben", "10.0.0.1");
  clock_.Advance(minutes(61));
  Fail(1, "ben", "10.0.0.1");
  EXPECT_TRUE(throttle_.CheckAccount("ben").ok());
}

TEST_F(LoginThrottleTest, GivesAnAddressTwentyFailuresAMinute) {
  for (int i = 0; i < 20; ++i) Fail(1, Str("user", i), "10.0.0.1");
  EXPECT_EQ(throttle_.CheckAddress("10.0.0.1").code(), StatusCode::kResourceExhausted);
  EXPECT_TRUE(throttle_.CheckAddress("10.0.0.2").ok());
  clock_.Advance(seconds(3));
  EXPECT_TRUE(throttle_.CheckAddress("10.0.0.1").ok());
}

TEST_F(LoginThrottleTest, ComputesFewHashesForAThousandGuessesInAMinute) {
  // A guess that is not turned away costs a hash. From many addresses, as a botnet would.
  int hashes = 0;
  for (int i = 0; i < 1000; ++i) {
    if (throttle_.CheckAccount("maria").ok()) {
      ++hashes;
      throttle_.Failed("maria", Str("10.0.", i % 250, ".1"));
    }
    clock_.Advance(milliseconds(60));
  }
  // Five, then after 1, 2, 4, 8, 16 and 32 seconds.
  EXPECT_LE(hashes, 11);
  EXPECT_GE(hashes, 5);
}

TEST_F(LoginThrottleTest, StaysSmallWhenNamesAreInvented) {
  Fail(5, "maria", "10.0.0.1");
  for (int i = 0; i < 4200; ++i) {
    clock_.Advance(milliseconds(1));
    Fail(1, Str("invented", i), "10.0.0.2");
  }
  // The one that failed longest ago had to go: that is how one sees that the number is bounded.
  EXPECT_TRUE(throttle_.CheckAccount("maria").ok());
  EXPECT_EQ(throttle_.CheckAddress("10.0.0.2").code(), StatusCode::kResourceExhausted);
}

}  // namespace
}  // namespace vs
