#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "tests/support/block_harness.h"

namespace vs {
namespace {

using test::BlockHarness;

class RangeCheck : public ::testing::Test {
 protected:
  RangeCheck() {
    EXPECT_TRUE(block_.Set("min", 10.0).ok());
    EXPECT_TRUE(block_.Set("max", 20.0).ok());
    EXPECT_TRUE(block_.Set("warn_margin", 1.0).ok());
  }
  std::string Check(double value) {
    block_.Input("value", value);
    EXPECT_TRUE(block_.Run().ok());
    const std::string& verdict = *block_.Output<std::string>("result_class");
    EXPECT_EQ(*block_.Output<bool>("pass"), verdict != "fail");
    return verdict;
  }
  double margin() const { return *block_.Output<double>("margin"); }

  BlockHarness block_{"RangeCheck"};
};

TEST_F(RangeCheck, JudgesByBothLimits) {
  EXPECT_EQ(Check(15), "pass");
  EXPECT_EQ(margin(), 5);
  EXPECT_EQ(Check(19.5), "warn");
  EXPECT_EQ(margin(), 0.5);
  EXPECT_EQ(Check(10), "warn");
  EXPECT_EQ(Check(9), "fail");
  EXPECT_EQ(margin(), -1);
  EXPECT_EQ(Check(1000), "fail");
}

TEST_F(RangeCheck, JudgesByOneLimitOnly) {
  ASSERT_TRUE(block_.Set("limits", std::string("min")).ok());
  EXPECT_EQ(Check(1000), "pass");
  EXPECT_EQ(Check(9), "fail");
  ASSERT_TRUE(block_.Set("limits", std::string("max")).ok());
  EXPECT_EQ(Check(-1000), "pass");
  EXPECT_EQ(Check(21), "fail");
}

TEST_F(RangeCheck, FailsWhatIsNoNumber) {
  EXPECT_EQ(Check(std::numeric_limits<double>::quiet_NaN()), "fail");
  EXPECT_TRUE(std::isnan(margin()));
  EXPECT_EQ(Check(std::numeric_limits<double>::infinity()), "fail");
}

TEST_F(RangeCheck, RefusesLimitsThatAreSwapped) {
  ASSERT_TRUE(block_.Set("min", 21.0).ok());
  EXPECT_EQ(block_.Start(), InvalidArgument("min (21) must not be above max (20)"));
  ASSERT_TRUE(block_.Set("limits", std::string("min")).ok());
  EXPECT_TRUE(block_.Start().ok()) << "max does not count";
}

}  // namespace
}  // namespace vs
