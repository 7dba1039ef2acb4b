#include "engine/core/param.h"

#include <algorithm>
#include <cmath>

#include "engine/base/str.h"

namespace vs {
namespace {

std::string_view TypeName(const ParamValue& value) {
  static constexpr std::string_view kNames[] = {"true or false", "an integer", "a number",
                                                "a text"};
  return kNames[value.index()];
}

std::string RangeText(const ParamInfo& info) {
  const std::string unit = info.unit.empty() ? "" : " " + info.unit;
  if (info.min && info.max) return Str(*info.min, " to ", *info.max, unit);
  if (info.min) return Str("at least ", *info.min, unit);
  return Str("at most ", *info.max, unit);
}

std::string Joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

}  // namespace

std::string ToString(const ParamValue& value) {
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  if (const auto* integer = std::get_if<int64_t>(&value)) return std::to_string(*integer);
  if (const auto* number = std::get_if<double>(&value)) return Str(*number);
  return std::get<std::string>(value);
}

Status ParamBase::Check(const ParamValue& value) const {
  const bool integer_for_number =
      std::holds_alternative<double>(info_.initial) && std::holds_alternative<int64_t>(value);
  if (value.index() != info_.initial.index() && !integer_for_number) {
    return InvalidArgument(Str(info_.name, " must be ", TypeName(info_.initial), ", not ",
                               TypeName(value), " (", ToString(value), ")"));
  }
  if (info_.min || info_.max) {
    const auto* integer = std::get_if<int64_t>(&value);
    const double number =
        integer != nullptr ? static_cast<double>(*integer) : std::get<double>(value);
    if (!std::isfinite(number) || (info_.min && number < *info_.min) ||
        (info_.max && number > *info_.max)) {
      return OutOfRange(Str(info_.name, " must be ", RangeText(info_), ", not ", ToString(value)));
    }
  } else if (const auto* number = std::get_if<double>(&value); number && !std::isfinite(*number)) {
    return OutOfRange(Str(info_.name, " must be a finite number"));
  }
  if (!info_.choices.empty()) {
    const auto& text = std::get<std::string>(value);
    if (std::find(info_.choices.begin(), info_.choices.end(), text) == info_.choices.end()) {
      return OutOfRange(
          Str(info_.name, " must be one of ", Joined(info_.choices), ", not \"", text, "\""));
    }
  }
  return Status();
}

Status ParamBase::Set(const ParamValue& value) {
  VS_RETURN_IF_ERROR(Check(value));
  Assign(value);
  return Status();
}

}  // namespace vs
