#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/base/status.h"

namespace vs {

// A formula over named numbers, such as "(a + b) / 2 > 3 && c < max(a, 1)".
//
// From weak to strong: || then && then == != < <= > >= then + - then * / % then unary - and !;
// parentheses, decimal numbers, if(condition, then, otherwise) and the functions abs atan2 ceil cos
// exp floor hypot log max min pow round sin sqrt tan. True is 1 and false is 0; all but 0 and NaN
// count as true. Arithmetic of IEEE doubles: 1 / 0 is infinite, sqrt(-1) is NaN.
class Formula {
 public:
  // INVALID_ARGUMENT with the place ("at character 5: ...") of what is no formula, or nested too
  // deeply.
  static Result<Formula> Parse(std::string_view text, const std::vector<std::string>& names);

  // `values` are those of the names, in their order. Takes no heap memory. Thread-safe.
  double Evaluate(const double* values) const;
  // Whether the formula mentions the name of this index.
  bool Uses(int name) const;

 private:
  friend class FormulaParser;

  // One of: a number, a name, a function of one or of two numbers, or the choice of if().
  struct Step {
    double number = 0;
    int name = -1;
    double (*unary)(double) = nullptr;
    double (*binary)(double, double) = nullptr;
    bool choice = false;
  };

  // Postfix: operands come before what combines them.
  std::vector<Step> steps_;
};

}  // namespace vs
