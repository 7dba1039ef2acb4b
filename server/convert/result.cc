#include "server/convert/result.h"

#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "engine/base/str.h"
#include "server/convert/time.h"
#include "server/convert/value.h"

namespace vs {
namespace {

namespace pb = visionserver::v1;

void Set(std::monostate, pb::Value*) {}
void Set(int64_t value, pb::Value* out) { out->set_int_value(value); }
void Set(double value, pb::Value* out) { out->set_double_value(value); }
void Set(const std::string& value, pb::Value* out) { out->set_string_value(value); }
void Set(const SqlBlob& value, pb::Value* out) { out->set_bytes_value(value.bytes); }

pb::ResultState ToProto(ResultRecord::State state) {
  switch (state) {
    case ResultRecord::State::kCompleted:
      return pb::RESULT_STATE_COMPLETED;
    case ResultRecord::State::kAborted:
      return pb::RESULT_STATE_ABORTED;
    case ResultRecord::State::kFailed:
      return pb::RESULT_STATE_FAILED;
  }
  return pb::RESULT_STATE_UNSPECIFIED;
}

pb::ResultClass ToProto(ResultRecord::Class result_class) {
  switch (result_class) {
    case ResultRecord::Class::kUndefined:
      return pb::RESULT_CLASS_UNSPECIFIED;
    case ResultRecord::Class::kPass:
      return pb::RESULT_CLASS_PASS;
    case ResultRecord::Class::kWarn:
      return pb::RESULT_CLASS_WARN;
    case ResultRecord::Class::kFail:
      return pb::RESULT_CLASS_FAIL;
  }
  return pb::RESULT_CLASS_UNSPECIFIED;
}

Result<std::optional<ResultRecord::Class>> FromProto(pb::ResultClass result_class) {
  using Class = std::optional<ResultRecord::Class>;
  switch (result_class) {
    case pb::RESULT_CLASS_UNSPECIFIED:
      return Class();
    case pb::RESULT_CLASS_PASS:
      return Class(ResultRecord::Class::kPass);
    case pb::RESULT_CLASS_WARN:
      return Class(ResultRecord::Class::kWarn);
    case pb::RESULT_CLASS_FAIL:
      return Class(ResultRecord::Class::kFail);
    default:
      return InvalidArgument(Str("there is no result class ", int{result_class}));
  }
}

Result<std::optional<ResultRecord::State>> FromProto(pb::ResultState state) {
  using State = std::optional<ResultRecord::State>;
  switch (state) {
    case pb::RESULT_STATE_UNSPECIFIED:
      return State();
    case pb::RESULT_STATE_COMPLETED:
      return State(ResultRecord::State::kCompleted);
    case pb::RESULT_STATE_ABORTED:
      return State(ResultRecord::State::kAborted);
    case pb::RESULT_STATE_FAILED:
      return State(ResultRecord::State::kFailed);
    default:
      return InvalidArgument(Str("there is no result state ", int{state}));
  }
}

}  // namespace

pb::Result ToProto(const StoredResult& stored) {
  const ResultRecord& record = stored.record;
  pb::Result result;
  result.set_result_id(stored.result_id);
  result.set_number(stored.number);
  result.set_job_id(record.job_id);
  result.set_part_id(record.part_id);
  result.set_meas_id(record.meas_id);
  result.set_sequence_revision(record.sequence_revision);
  result.set_parameter_hash(ParameterHashText(record.parameter_hash));
  result.set_frame_number(record.frame_number);
  *result.mutable_creation_time() = ToTimestamp(stored.creation_time_ns);
  if (stored.acquisition_time_ns != 0) {
    *result.mutable_acquisition_time() = ToTimestamp(stored.acquisition_time_ns);
  }
  *result.mutable_processing_duration() = ToDuration(record.processing_ns);
  result.set_result_state(ToProto(record.state));
  result.set_result_class(ToProto(record.result_class));
  result.set_reason(record.reason);
  for (const auto& [name, value] : record.values) {
    pb::ResultField* field = result.add_fields();
    field->set_name(name);
    *field->mutable_value() = ToProto(value);
  }
  return result;
}

Result<ResultFilter> FromProto(const pb::ResultFilter& filter) {
  ResultFilter result{.job_id = filter.job_id(), .part_id = filter.part_id()};
  if (filter.has_from()) result.from_ns = ToUtcNs(filter.from());
  if (filter.has_until()) result.until_ns = ToUtcNs(filter.until());
  VS_ASSIGN_OR_RETURN(result.result_class, FromProto(filter.result_class()));
  VS_ASSIGN_OR_RETURN(result.result_state, FromProto(filter.result_state()));
  return result;
}

pb::Table ToProto(const SqlTable& table) {
  pb::Table result;
  for (const std::string& column : table.columns) result.add_columns(column);
  for (const auto& row : table.rows) {
    pb::Table::Row* cells = result.add_rows();
    for (const SqlValue& cell : row) {
      pb::Value* value = cells->add_cells();
      std::visit([value](const auto& held) { Set(held, value); }, cell);
    }
  }
  return result;
}

Result<SqlValue> ToSqlValue(const pb::Value& value) {
  switch (value.kind_case()) {
    case pb::Value::KIND_NOT_SET:
      return SqlValue();
    case pb::Value::kBoolValue:
      return SqlValue(int64_t{value.bool_value()});
    case pb::Value::kIntValue:
      return SqlValue(value.int_value());
    case pb::Value::kDoubleValue:
      return SqlValue(value.double_value());
    case pb::Value::kStringValue:
      return SqlValue(value.string_value());
    case pb::Value::kBytesValue:
      return SqlValue(SqlBlob{value.bytes_value()});
    default:
      return InvalidArgument("an argument of a query is a number, a text, bytes or nothing");
  }
}

}  // namespace vs
