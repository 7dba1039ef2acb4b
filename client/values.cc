#include "client/values.h"

#include <array>
#include <charconv>

namespace vs::client {

namespace v1 = ::visionserver::v1;

std::string ToText(const v1::Value& value) {
  switch (value.kind_case()) {
    case v1::Value::kBoolValue:
      return value.bool_value() ? "true" : "false";
    case v1::Value::kIntValue:
      return std::to_string(value.int_value());
    case v1::Value::kDoubleValue: {
      std::array<char, 32> text{};
      const auto end = std::to_chars(text.data(), text.data() + text.size(), value.double_value());
      return {text.data(), end.ptr};
    }
    case v1::Value::kStringValue:
      return value.string_value();
    case v1::Value::kBytesValue:
      return "(" + std::to_string(value.bytes_value().size()) + " bytes)";
    case v1::Value::kListValue: {
      std::string text;
      for (const v1::Value& one : value.list_value().values()) {
        text += (text.empty() ? "" : ", ") + ToText(one);
      }
      return "[" + text + "]";
    }
    case v1::Value::kTableValue:
      return "(table of " + std::to_string(value.table_value().rows_size()) + " rows)";
    case v1::Value::KIND_NOT_SET:
      return "";
  }
  return "";
}

}  // namespace vs::client
