#include "server/convert/parameter.h"

#include <utility>

#include "engine/base/str.h"
#include "server/convert/sequence.h"
#include "server/convert/value.h"

namespace vs {

namespace pb = visionserver::v1;

pb::Parameter ToProto(const BlockParameter& parameter) {
  pb::Parameter result;
  result.set_path(parameter.block + "." + parameter.info().name);
  *result.mutable_value() = ToProto(parameter.value);
  *result.mutable_info() = ToProto(parameter.info());
  return result;
}

pb::ParameterValue ToProto(const ParamAssignment& assignment) {
  pb::ParameterValue result;
  result.set_path(assignment.block + "." + assignment.param);
  *result.mutable_value() = ToProto(assignment.value);
  return result;
}

Result<std::vector<ParamAssignment>> FromProto(
    const google::protobuf::RepeatedPtrField<pb::ParameterValue>& values) {
  std::vector<ParamAssignment> assignments;
  std::vector<Fault> faults;
  for (const pb::ParameterValue& value : values) {
    Result<ParamAssignment> assignment = SplitPath(value.path());
    Result<ParamValue> converted = ToParamValue(value.value());
    if (!assignment) {
      faults.push_back({value.path(), assignment.error().message()});
    } else if (!converted) {
      faults.push_back({value.path(), converted.error().message()});
    } else {
      assignment->value = std::move(*converted);
      assignments.push_back(std::move(*assignment));
    }
  }
  if (faults.empty()) return assignments;
  std::string first =
      Str("nothing was changed: ", Quoted(faults.front().subject), ": ", faults.front().message);
  return Status(StatusCode::kInvalidArgument, std::move(first), std::move(faults));
}

}  // namespace vs
