#include "server/convert/value.h"

#include <type_traits>
#include <variant>

namespace vs {
namespace {

namespace pb = visionserver::v1;

void Set(bool value, pb::Value* out) { out->set_bool_value(value); }
void Set(int64_t value, pb::Value* out) { out->set_int_value(value); }
void Set(double value, pb::Value* out) { out->set_double_value(value); }
void Set(const std::string& value, pb::Value* out) { out->set_string_value(value); }
void Set(const Trigger& value, pb::Value* out) { out->set_int_value(value.time_ns); }
void Set(std::monostate, pb::Value*) {}

void Set(const List& list, pb::Value* out) {
  pb::ValueList* values = out->mutable_list_value();
  for (const Value& one : list) *values->add_values() = ToProto(one);
}

void Set(const Table& table, pb::Value* out) {
  pb::Table* result = out->mutable_table_value();
  for (const std::string& column : table.columns) result->add_columns(column);
  for (const List& row : table.rows) {
    pb::Table::Row* cells = result->add_rows();
    for (const Value& cell : row) *cells->add_cells() = ToProto(cell);
  }
}

template <class T>
void Set(const std::shared_ptr<const T>& shared, pb::Value* out) {
  if constexpr (std::is_same_v<T, List> || std::is_same_v<T, Table>) Set(*shared, out);
}

}  // namespace

pb::Value ToProto(const ParamValue& value) {
  pb::Value result;
  std::visit([&result](const auto& held) { Set(held, &result); }, value);
  return result;
}

Result<ParamValue> ToParamValue(const pb::Value& value) {
  switch (value.kind_case()) {
    case pb::Value::kBoolValue:
      return value.bool_value();
    case pb::Value::kIntValue:
      return value.int_value();
    case pb::Value::kDoubleValue:
      return value.double_value();
    case pb::Value::kStringValue:
      return value.string_value();
    default:
      return InvalidArgument("the value must be true or false, a number or a text");
  }
}

pb::Value ToProto(const Value& value) {
  pb::Value result;
  std::visit([&result](const auto& held) { Set(held, &result); }, value.variant());
  return result;
}

}  // namespace vs
