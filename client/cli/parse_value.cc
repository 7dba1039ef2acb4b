#include "client/cli/parse_value.h"

#include <charconv>
#include <cmath>
#include <optional>

#include "client/values.h"

namespace vs::cli {

namespace v1 = ::visionserver::v1;

namespace {

using client::Code;
using client::Failure;
using client::Result;
using client::ToValue;

tl::unexpected<client::Error> Expected(const NameAndText& setting, const std::string& what) {
  return Failure(Code::kInvalidArgument,
                 setting.name + " takes " + what + ", not \"" + setting.text + "\"");
}

template <class T>
std::optional<T> ParseNumber(const std::string& text) {
  T number{};
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || rest != end) return std::nullopt;
  return number;
}

Result<v1::Value> ParseBool(const NameAndText& setting) {
  for (const char* word : {"true", "on", "yes", "1"}) {
    if (setting.text == word) return ToValue(true);
  }
  for (const char* word : {"false", "off", "no", "0"}) {
    if (setting.text == word) return ToValue(false);
  }
  return Expected(setting, "true or false");
}

Result<v1::Value> ParseInt(const NameAndText& setting) {
  const std::optional<int64_t> number = ParseNumber<int64_t>(setting.text);
  if (!number) return Expected(setting, "a whole number");
  return ToValue(*number);
}

Result<v1::Value> ParseDouble(const NameAndText& setting) {
  const std::optional<double> number = ParseNumber<double>(setting.text);
  if (!number || !std::isfinite(*number)) return Expected(setting, "a number");
  return ToValue(*number);
}

}  // namespace

Result<std::vector<NameAndText>> InPairs(const std::vector<std::string>& words,
                                         const std::string& form) {
  if (words.size() % 2 != 0) {
    return Failure(Code::kInvalidArgument,
                   "\"" + words.back() + "\" has no value; write " + form + " [" + form + "]...");
  }
  std::vector<NameAndText> pairs;
  for (size_t i = 0; i < words.size(); i += 2) pairs.push_back({words[i], words[i + 1]});
  return pairs;
}

Result<v1::Value> ParseParameter(const NameAndText& setting, const v1::ParameterInfo& info) {
  switch (info.type()) {
    case v1::PARAMETER_TYPE_BOOL:
      return ParseBool(setting);
    case v1::PARAMETER_TYPE_INT:
      return ParseInt(setting);
    case v1::PARAMETER_TYPE_DOUBLE:
      return ParseDouble(setting);
    default:
      return ToValue(setting.text);
  }
}

Result<v1::Value> ParseFeature(const NameAndText& setting, v1::FeatureType type) {
  switch (type) {
    case v1::FEATURE_TYPE_BOOLEAN:
    case v1::FEATURE_TYPE_COMMAND:
      return ParseBool(setting);
    case v1::FEATURE_TYPE_INTEGER:
      return ParseInt(setting);
    case v1::FEATURE_TYPE_FLOAT:
      return ParseDouble(setting);
    default:
      return ToValue(setting.text);
  }
}

}  // namespace vs::cli
