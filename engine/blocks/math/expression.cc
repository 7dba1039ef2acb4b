// Computes a number from others by a formula.
#include <array>
#include <optional>

#include "engine/base/str.h"
#include "engine/core/block.h"
#include "engine/core/formula.h"

namespace vs {
namespace {

const std::vector<std::string>& InputNames() {
  static const std::vector<std::string> names = {"a", "b", "c", "d", "e", "f", "g", "h"};
  return names;
}

Status CheckFormula(const std::string& formula) {
  const auto parsed = Formula::Parse(formula, InputNames());
  return parsed ? Status() : parsed.error();
}

class Expression final : public Block {
 public:
  In<double> a{this, "a", "The number a of the formula.", Need::kSome};
  In<double> b{this, "b", "The number b of the formula.", Need::kSome};
  In<double> c{this, "c", "The number c of the formula.", Need::kSome};
  In<double> d{this, "d", "The number d of the formula.", Need::kSome};
  In<double> e{this, "e", "The number e of the formula.", Need::kSome};
  In<double> f{this, "f", "The number f of the formula.", Need::kSome};
  In<double> g{this, "g", "The number g of the formula.", Need::kSome};
  In<double> h{this, "h", "The number h of the formula.", Need::kSome};
  Out<double> result{this, "result", "What the formula gives; a comparison gives 1 or 0."};
  Out<bool> is_true{this, "is_true", "Whether the result is neither 0 nor undefined."};
  Param<std::string> formula{
      this,
      "formula",
      {.initial = "a",
       .doc = "For example (a + b) / 2 > 3 && c < max(a, 1). Operators || && == != < <= > >= + - * "
              "/ % !, functions abs atan2 ceil cos exp floor hypot if log max min pow round sin "
              "sqrt tan.",
       .check = CheckFormula}};

  Status Start() override { return Prepare(); }

  Status Run() override {
    if (*formula != prepared_) VS_RETURN_IF_ERROR(Prepare());
    std::array<double, 8> values{};
    const auto inputs = Inputs();
    for (size_t i = 0; i < inputs.size(); ++i) {
      if (inputs[i]->has_value()) {
        values[i] = **inputs[i];
      } else if (parsed_->Uses(static_cast<int>(i))) {
        return FailedPrecondition(Str("there is no value of ", InputNames()[i], " in this frame"));
      }
    }
    const double number = parsed_->Evaluate(values.data());
    result.Set(number);
    is_true.Set(number != 0 && number == number);
    return Status();
  }

 private:
  std::array<const In<double>*, 8> Inputs() const { return {&a, &b, &c, &d, &e, &f, &g, &h}; }

  Status Prepare() {
    prepared_.clear();
    VS_ASSIGN_OR_RETURN(parsed_, Formula::Parse(*formula, InputNames()));
    const auto inputs = Inputs();
    for (size_t i = 0; i < inputs.size(); ++i) {
      if (!inputs[i]->connected() && parsed_->Uses(static_cast<int>(i))) {
        return FailedPrecondition(
            Str("the formula uses ", InputNames()[i], ": connect this input"));
      }
    }
    prepared_ = *formula;
    return Status();
  }

  std::optional<Formula> parsed_;
  std::string prepared_;  // the formula that parsed_ stands for; empty = none
};

VS_REGISTER_BLOCK(Expression,
                  {.category = "Math", .doc = "Computes a number from others by a formula."});

}  // namespace
}  // namespace vs
