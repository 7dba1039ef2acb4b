#include "engine/core/formula.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "engine/base/str.h"

namespace vs {
namespace {

constexpr int kMaxOperands = 64;  // that wait to be combined
constexpr int kMaxNesting = 64;

using UnaryFunction = double (*)(double);
using BinaryFunction = double (*)(double, double);

bool IsTrue(double x) { return x != 0 && !std::isnan(x); }

struct Operator {
  std::string_view sign;
  int strength;
  BinaryFunction function;
};
// A sign that begins another stands behind it.
constexpr Operator kOperators[] = {
    {"||", 1, [](double x, double y) { return IsTrue(x) || IsTrue(y) ? 1.0 : 0.0; }},
    {"&&", 2, [](double x, double y) { return IsTrue(x) && IsTrue(y) ? 1.0 : 0.0; }},
    {"==", 3, [](double x, double y) { return x == y ? 1.0 : 0.0; }},
    {"!=", 3, [](double x, double y) { return x != y ? 1.0 : 0.0; }},
    {"<=", 3, [](double x, double y) { return x <= y ? 1.0 : 0.0; }},
    {">=", 3, [](double x, double y) { return x >= y ? 1.0 : 0.0; }},
    {"<", 3, [](double x, double y) { return x < y ? 1.0 : 0.0; }},
    {">", 3, [](double x, double y) { return x > y ? 1.0 : 0.0; }},
    {"+", 4, [](double x, double y) { return x + y; }},
    {"-", 4, [](double x, double y) { return x - y; }},
    {"*", 5, [](double x, double y) { return x * y; }},
    {"/", 5, [](double x, double y) { return x / y; }},
    {"%", 5, [](double x, double y) { return std::fmod(x, y); }},
};

constexpr std::pair<std::string_view, UnaryFunction> kUnaryFunctions[] = {
    {"abs", [](double x) { return std::fabs(x); }},
    {"ceil", [](double x) { return std::ceil(x); }},
    {"cos", [](double x) { return std::cos(x); }},
    {"exp", [](double x) { return std::exp(x); }},
    {"floor", [](double x) { return std::floor(x); }},
    {"log", [](double x) { return std::log(x); }},
    {"round", [](double x) { return std::round(x); }},
    {"sin", [](double x) { return std::sin(x); }},
    {"sqrt", [](double x) { return std::sqrt(x); }},
    {"tan", [](double x) { return std::tan(x); }},
};
constexpr std::pair<std::string_view, BinaryFunction> kBinaryFunctions[] = {
    {"atan2", [](double y, double x) { return std::atan2(y, x); }},
    {"hypot", [](double x, double y) { return std::hypot(x, y); }},
    {"max", [](double x, double y) { return std::max(x, y); }},
    {"min", [](double x, double y) { return std::min(x, y); }},
    {"pow", [](double x, double y) { return std::pow(x, y); }},
};

bool IsLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool IsDigit(char c) { return c >= '0' && c <= '9'; }

template <class Table>
auto FindFunction(const Table& table, std::string_view name) {
  const auto* found = std::find_if(std::begin(table), std::end(table),
                                   [name](const auto& entry) { return entry.first == name; });
  return found == std::end(table) ? nullptr : found->second;
}

}  // namespace

// Recursive descent; the first error ends it.
class FormulaParser {
 public:
  FormulaParser(std::string_view text, const std::vector<std::string>& names)
      : text_(text), names_(names) {}

  Result<Formula> Parse() {
    Combined(0);
    if (error_.empty() && !AtEnd()) Fail("expected an operator");
    if (!error_.empty()) return InvalidArgument(error_);
    return std::move(formula_);
  }

 private:
  using Step = Formula::Step;

  void Fail(std::string_view what) {
    if (error_.empty()) error_ = Str("at character ", at_ + 1, ": ", what);
  }
  bool AtEnd() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\n')) ++at_;
    return at_ == text_.size();
  }
  bool Next(std::string_view sign) { return !AtEnd() && text_.substr(at_, sign.size()) == sign; }
  bool Take(std::string_view sign) {
    const bool there = Next(sign);
    if (there) at_ += sign.size();
    return there;
  }
  void Expect(std::string_view sign) {
    if (!Take(sign)) Fail(Str("expected ", sign));
  }

  // `taken` operands become one.
  void Emit(const Step& step, int taken) {
    operands_ += 1 - taken;
    if (operands_ > kMaxOperands) Fail("too much is nested here");
    if (error_.empty()) formula_.steps_.push_back(step);
  }
  void EmitUnary(UnaryFunction function) {
    Step step;
    step.unary = function;
    Emit(step, 1);
  }
  void EmitBinary(BinaryFunction function) {
    Step step;
    step.binary = function;
    Emit(step, 2);
  }

  // An operand and what operators stronger than `weaker` combine it with.
  void Combined(int weaker) {
    if (++nesting_ > kMaxNesting) Fail("too much is nested here");
    if (error_.empty()) Operand();
    while (error_.empty()) {
      const auto* next = std::find_if(std::begin(kOperators), std::end(kOperators),
                                      [this](const Operator& one) { return Next(one.sign); });
      if (next == std::end(kOperators) || next->strength <= weaker) break;
      at_ += next->sign.size();
      Combined(next->strength);
      EmitBinary(next->function);
    }
    --nesting_;
  }

  void Operand() {
    constexpr int kStrongest = 6;
    const char next = AtEnd() ? '\0' : text_[at_];
    if (Take("(")) {
      Combined(0);
      Expect(")");
    } else if (Take("-")) {
      Combined(kStrongest);
      EmitUnary([](double x) { return -x; });
    } else if (Take("!")) {
      Combined(kStrongest);
      EmitUnary([](double x) { return IsTrue(x) ? 0.0 : 1.0; });
    } else if (IsDigit(next) || next == '.') {
      Number();
    } else if (IsLetter(next)) {
      Word();
    } else {
      Fail("expected a number, a name or (");
    }
  }

  void Number() {
    Step step;
    const char* begin = text_.data() + at_;
    const auto [end, error] = std::from_chars(begin, text_.data() + text_.size(), step.number);
    if (error != std::errc()) return Fail("this is not a number");
    at_ += static_cast<size_t>(end - begin);
    Emit(step, 0);
  }

  void Word() {
    const size_t begin = at_;
    size_t end = at_;
    while (end < text_.size() && (IsLetter(text_[end]) || IsDigit(text_[end]))) ++end;
    const std::string_view word = text_.substr(begin, end - begin);
    const auto name = std::find(names_.begin(), names_.end(), word);
    if (name != names_.end()) {
      at_ = end;
      Step step;
      step.name = static_cast<int>(name - names_.begin());
      return Emit(step, 0);
    }
    const UnaryFunction unary = FindFunction(kUnaryFunctions, word);
    const BinaryFunction binary = FindFunction(kBinaryFunctions, word);
    if (unary == nullptr && binary == nullptr && word != "if") {
      return Fail(Str(Quoted(word), " is neither a name nor a function here"));
    }
    at_ = end;
    if (unary != nullptr) {
      Arguments(1);
      EmitUnary(unary);
    } else if (binary != nullptr) {
      Arguments(2);
      EmitBinary(binary);
    } else {
      Arguments(3);
      Step step;
      step.choice = true;
      Emit(step, 3);
    }
  }

  void Arguments(int count) {
    Expect("(");
    for (int i = 0; i < count; ++i) {
      if (i > 0) Expect(",");
      if (error_.empty()) Combined(0);
    }
    Expect(")");
  }

  const std::string_view text_;
  const std::vector<std::string>& names_;
  size_t at_ = 0;
  int operands_ = 0;
  int nesting_ = 0;
  std::string error_;
  Formula formula_;
};

Result<Formula> Formula::Parse(std::string_view text, const std::vector<std::string>& names) {
  return FormulaParser(text, names).Parse();
}

double Formula::Evaluate(const double* values) const {
  double stack[kMaxOperands] = {};
  int top = -1;
  for (const Step& step : steps_) {
    if (step.unary != nullptr) {
      stack[top] = step.unary(stack[top]);
    } else if (step.binary != nullptr) {
      --top;
      stack[top] = step.binary(stack[top], stack[top + 1]);
    } else if (step.choice) {
      top -= 2;
      stack[top] = IsTrue(stack[top]) ? stack[top + 1] : stack[top + 2];
    } else {
      stack[++top] = step.name < 0 ? step.number : values[step.name];
    }
  }
  return stack[0];
}

bool Formula::Uses(int name) const {
  return std::any_of(steps_.begin(), steps_.end(),
                     [name](const Step& step) { return step.name == name; });
}

}  // namespace vs
