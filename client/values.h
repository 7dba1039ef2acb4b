#pragma once

#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>

#include "visionserver/v1/value.pb.h"

namespace vs::client {

// A parameter's or feature's value: ToValue(96), ToValue(0.5), ToValue(true), ToValue("census").
inline visionserver::v1::Value ToValue(bool value) {
  visionserver::v1::Value proto;
  proto.set_bool_value(value);
  return proto;
}
template <std::integral T>
requires(!std::same_as<T, bool>) visionserver::v1::Value ToValue(T value) {
  visionserver::v1::Value proto;
  proto.set_int_value(static_cast<int64_t>(value));
  return proto;
}
inline visionserver::v1::Value ToValue(double value) {
  visionserver::v1::Value proto;
  proto.set_double_value(value);
  return proto;
}
inline visionserver::v1::Value ToValue(std::string_view value) {
  visionserver::v1::Value proto;
  proto.set_string_value(std::string(value));
  return proto;
}
inline visionserver::v1::Value ToValue(const char* value) {
  return ToValue(std::string_view(value));
}

// For people: 12, 0.25, true, census, [1, 2], "" for null.
std::string ToText(const visionserver::v1::Value& value);

}  // namespace vs::client
