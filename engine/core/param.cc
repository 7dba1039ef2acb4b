#include "engine/core/param.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "engine/base/str.h"

namespace vs {
namespace {

constexpr size_t kMaxTextBytes = 4096;

std::string_view TypeName(const ParamValue& value) {
  static constexpr std::string_view kNames[] = {"true or false", "an integer", "a number",
                                                "a text"};
  return kNames[value.index()];
}

// The shortest text that means exactly this number.
std::string NumberText(double number) {
  char text[32];
  return std::string(text, std::to_chars(text, text + sizeof text, number).ptr);
}

std::string RangeText(const ParamInfo& info) {
  const std::string unit = info.unit.empty() ? "" : " " + info.unit;
  if (info.min && info.max) {
    return Str(NumberText(*info.min), " to ", NumberText(*info.max), unit);
  }
  if (info.min) return Str("at least ", NumberText(*info.min), unit);
  return Str("at most ", NumberText(*info.max), unit);
}

std::string Joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

std::string Shown(const ParamValue& value) {
  const auto* text = std::get_if<std::string>(&value);
  return text != nullptr ? Quoted(*text) : ToString(value);
}

Status CheckNumber(const ParamInfo& info, const ParamValue& value) {
  const auto* integer = std::get_if<int64_t>(&value);
  const double number =
      integer != nullptr ? static_cast<double>(*integer) : std::get<double>(value);
  if (!std::isfinite(number)) return OutOfRange(Str(info.name, " must be a finite number"));
  if ((info.min && number < *info.min) || (info.max && number > *info.max)) {
    return OutOfRange(Str(info.name, " must be ", RangeText(info), ", not ", ToString(value)));
  }
  const bool holds_int = std::holds_alternative<int64_t>(info.initial);
  if (holds_int && *integer != static_cast<int>(*integer)) {
    return OutOfRange(Str(info.name, " must fit into 32 bits, ", ToString(value), " does not"));
  }
  return Status();
}

Status CheckText(const ParamInfo& info, const std::string& text) {
  if (text.size() > kMaxTextBytes) {
    return OutOfRange(
        Str(info.name, " must have at most ", kMaxTextBytes, " bytes, not ", text.size()));
  }
  if (std::any_of(text.begin(), text.end(),
                  [](char c) { return c >= 0 && c < ' ' && c != '\n'; })) {
    return InvalidArgument(
        Str(info.name, " must not contain control characters, as ", Quoted(text), " does"));
  }
  if (!info.choices.empty() &&
      std::find(info.choices.begin(), info.choices.end(), text) == info.choices.end()) {
    return OutOfRange(
        Str(info.name, " must be one of ", Joined(info.choices), ", not ", Quoted(text)));
  }
  return Status();
}

}  // namespace

std::string ToString(const ParamValue& value) {
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  if (const auto* integer = std::get_if<int64_t>(&value)) return std::to_string(*integer);
  if (const auto* number = std::get_if<double>(&value)) return NumberText(*number);
  return std::get<std::string>(value);
}

Status ParamBase::Check(const ParamValue& value) const {
  const bool integer_for_number =
      std::holds_alternative<double>(info_.initial) && std::holds_alternative<int64_t>(value);
  if (value.index() != info_.initial.index() && !integer_for_number) {
    return InvalidArgument(Str(info_.name, " must be ", TypeName(info_.initial), ", not ",
                               TypeName(value), " (", Shown(value), ")"));
  }
  if (const auto* text = std::get_if<std::string>(&value)) {
    VS_RETURN_IF_ERROR(CheckText(info_, *text));
  } else if (!std::holds_alternative<bool>(value)) {
    VS_RETURN_IF_ERROR(CheckNumber(info_, value));
  }
  return CheckFurther(value).Annotated(info_.name);
}

ParamValue ParamBase::AsHeld(const ParamValue& value) const {
  const auto* integer = std::get_if<int64_t>(&value);
  if (integer == nullptr || !std::holds_alternative<double>(info_.initial)) return value;
  return static_cast<double>(*integer);
}

Status ParamBase::Set(const ParamValue& value) {
  VS_RETURN_IF_ERROR(Check(value));
  Assign(value);
  return Status();
}

}  // namespace vs
