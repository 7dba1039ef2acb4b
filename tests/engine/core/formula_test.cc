#include "engine/core/formula.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace vs {
namespace {

const std::vector<std::string> kNames = {"a", "b", "part_1"};

double Value(const std::string& text) {
  const double values[] = {3, 4, 0.5};
  const auto formula = Formula::Parse(text, kNames);
  return formula ? formula->Evaluate(values) : std::numeric_limits<double>::quiet_NaN();
}

std::string ErrorOf(const std::string& text) {
  const auto formula = Formula::Parse(text, kNames);
  return formula ? "none" : formula.error().message();
}

TEST(Formula, FollowsTheUsualStrengthOfOperators) {
  EXPECT_EQ(Value("1 + 2 * 3"), 7);
  EXPECT_EQ(Value("(1 + 2) * 3"), 9);
  EXPECT_EQ(Value("10 - 4 - 3"), 3);
  EXPECT_EQ(Value("100 / 10 / 5"), 2);
  EXPECT_EQ(Value("17 % 5 * 2"), 4);
  EXPECT_EQ(Value("-a * -b"), 12);
  EXPECT_EQ(Value("2 - -1"), 3);
  EXPECT_EQ(Value("1 + 1 == 2"), 1);
  EXPECT_EQ(Value("0 && 0 || 1"), 1);
  EXPECT_EQ(Value("1 || 0 && 0"), 1);
  EXPECT_EQ(Value("!a == 0"), 1);
  EXPECT_EQ(Value("1 < 2 && 2 <= 2 && 3 > 2 && 2 >= 2 && 1 != 2"), 1);
}

TEST(Formula, KnowsNamesNumbersAndFunctions) {
  EXPECT_EQ(Value("a+b*part_1"), 5);
  EXPECT_EQ(Value(".5e1"), 5);
  EXPECT_EQ(Value("max(a, b) - min(a, b)"), 1);
  EXPECT_EQ(Value("hypot(a, b)"), 5);
  EXPECT_EQ(Value("if(a > b, 10, 20)"), 20);
  EXPECT_EQ(Value("round(2.5) + floor(-0.5) + ceil(0.2) + abs(-1)"), 4);
  EXPECT_EQ(Value("pow(2, 10) + sqrt(16)"), 1028);
  EXPECT_EQ(Value("exp(0) + log(1) + cos(0) + sin(0) + tan(0) + atan2(0, 1)"), 2);
}

TEST(Formula, ComputesAsIeeeNumbersDo) {
  EXPECT_EQ(Value("1 / 0"), std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(Formula::Parse("sqrt(-1)", {})->Evaluate(nullptr)));
  EXPECT_EQ(Value("if(sqrt(-1), 1, 2)"), 2) << "what is no number is not true";
  EXPECT_EQ(Value("!sqrt(-1)"), 1);
}

TEST(Formula, SaysWhereItIsWrong) {
  EXPECT_EQ(ErrorOf(""), "at character 1: expected a number, a name or (");
  EXPECT_EQ(ErrorOf("a +"), "at character 4: expected a number, a name or (");
  EXPECT_EQ(ErrorOf("a b"), "at character 3: expected an operator");
  EXPECT_EQ(ErrorOf("(a"), "at character 3: expected )");
  EXPECT_EQ(ErrorOf("a + z"), "at character 5: \"z\" is neither a name nor a function here");
  EXPECT_EQ(ErrorOf("max(a)"), "at character 6: expected ,");
  EXPECT_EQ(ErrorOf("sin a"), "at character 5: expected (");
  EXPECT_EQ(ErrorOf("1e999"), "at character 1: this is not a number");
  EXPECT_EQ(ErrorOf("a = b"), "at character 3: expected an operator");
}

TEST(Formula, BoundsNesting) {
  const std::string deep(100'000, '(');
  EXPECT_NE(ErrorOf(deep).find("too much is nested here"), std::string::npos);
  EXPECT_NE(ErrorOf(std::string(100'000, '-') + "1").find("too much"), std::string::npos);
  std::string sum = "1";
  for (int i = 0; i < 1000; ++i) sum += " + 1";
  EXPECT_EQ(Value(sum), 1001) << "long is not deep";
}

TEST(Formula, KnowsWhichNamesItUses) {
  const auto formula = Formula::Parse("a + 2 * part_1", kNames).value();
  EXPECT_TRUE(formula.Uses(0));
  EXPECT_FALSE(formula.Uses(1));
  EXPECT_TRUE(formula.Uses(2));
}

TEST(Formula, SurvivesRandomText) {
  std::mt19937 random(1);
  const std::vector<std::string> pieces = {"a",  "b", "part_1", "(", ")", ",",   "+",
                                           "-",  "!", "&&",     "<", "1", ".5",  "max",
                                           "if", "e", " ",      "=", "%", "\xff"};
  int accepted = 0;
  for (int round = 0; round < 50'000; ++round) {
    std::string text;
    for (size_t i = 1 + random() % 8; i > 0; --i) text += pieces[random() % pieces.size()];
    const auto formula = Formula::Parse(text, kNames);
    if (!formula) continue;
    ++accepted;
    const double values[] = {1, 2, 3};
    formula->Evaluate(values);
  }
  EXPECT_GT(accepted, 1000);
}

}  // namespace
}  // namespace vs
