#include <gtest/gtest.h>

#include <map>
#include <string>

#include "tests/support/block_harness.h"

namespace vs {
namespace {

using test::BlockHarness;

// The verdict on checks "1" (passed), "0" (failed) and "?" (no answer), one for each input.
std::string Verdict(const std::string& checks, const std::string& mode, int64_t needed = 1) {
  BlockHarness block("PassFail");
  EXPECT_TRUE(block.Set("mode", mode).ok());
  EXPECT_TRUE(block.Set("needed", needed).ok());
  for (size_t i = 0; i < checks.size(); ++i) {
    const std::string port(1, static_cast<char>('a' + i));
    block.block().FindInput(port)->Connect("bool");
    if (checks[i] != '?') block.Input(port, checks[i] == '1');
  }
  EXPECT_TRUE(block.Start().ok());
  EXPECT_TRUE(block.Run().ok());
  const bool pass = *block.Output<bool>("pass");
  std::string verdict = *block.Output<std::string>("result_class");
  EXPECT_EQ(pass, verdict == "pass");
  return verdict;
}

TEST(PassFail, WantsAllOfTheConnectedChecks) {
  EXPECT_EQ(Verdict("1", "all"), "pass");
  EXPECT_EQ(Verdict("11111111", "all"), "pass");
  EXPECT_EQ(Verdict("1101", "all"), "fail");
}

TEST(PassFail, WantsAnyOrSoMany) {
  EXPECT_EQ(Verdict("0010", "any"), "pass");
  EXPECT_EQ(Verdict("00", "any"), "fail");
  EXPECT_EQ(Verdict("1010", "at_least", 2), "pass");
  EXPECT_EQ(Verdict("1000", "at_least", 2), "fail");
  EXPECT_EQ(Verdict("11", "at_least", 3), "fail") << "more than are connected";
}

TEST(PassFail, NeverPassesOnACheckThatGaveNoAnswer) {
  EXPECT_EQ(Verdict("1?", "all"), "undefined");
  EXPECT_EQ(Verdict("0?", "all"), "fail");
  EXPECT_EQ(Verdict("?", "any"), "undefined");
  EXPECT_EQ(Verdict("1?", "any"), "pass") << "certain without it";
  EXPECT_EQ(Verdict("1?0", "at_least", 2), "undefined");
}

}  // namespace
}  // namespace vs
