#include <gtest/gtest.h>

#include <string>

#include "tests/support/block_harness.h"

namespace vs {
namespace {

using test::BlockHarness;

class Expression : public ::testing::Test {
 protected:
  Expression() {
    block_.Input("a", 3.0);
    block_.Input("c", 4.0);
  }
  Status Set(const std::string& formula) { return block_.Set("formula", formula); }

  BlockHarness block_{"Expression"};
};

TEST_F(Expression, ComputesItsFormulaAlsoWhenThatChanges) {
  ASSERT_TRUE(Set("a * c").ok());
  ASSERT_TRUE(block_.Start().ok());
  ASSERT_TRUE(block_.Run().ok());
  EXPECT_EQ(*block_.Output<double>("result"), 12);
  EXPECT_TRUE(*block_.Output<bool>("is_true"));
  ASSERT_TRUE(Set("a > c").ok());
  ASSERT_TRUE(block_.Run().ok());
  EXPECT_EQ(*block_.Output<double>("result"), 0);
  EXPECT_FALSE(*block_.Output<bool>("is_true"));
}

TEST_F(Expression, RefusesWhatIsNoFormula) {
  EXPECT_EQ(Set("a +"), InvalidArgument("formula: at character 4: expected a number, a name or ("));
  EXPECT_FALSE(Set("system(1)").ok());
}

TEST_F(Expression, NeedsTheInputsThatItsFormulaUses) {
  ASSERT_TRUE(Set("a + b").ok());
  EXPECT_EQ(block_.Start(), FailedPrecondition("the formula uses b: connect this input"));
  ASSERT_TRUE(Set("a + c").ok());
  ASSERT_TRUE(block_.Start().ok());
  block_.Input("c", Value());
  EXPECT_EQ(block_.Run(), FailedPrecondition("there is no value of c in this frame"));
  EXPECT_TRUE(block_.Output("result").empty());
  ASSERT_TRUE(Set("a").ok());
  EXPECT_TRUE(block_.Run().ok()) << "it does not need c any more";
}

}  // namespace
}  // namespace vs
