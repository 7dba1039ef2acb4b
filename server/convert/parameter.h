#pragma once

#include <google/protobuf/repeated_ptr_field.h>

#include <vector>

#include "visionserver/v1/parameter.pb.h"

#include "engine/base/status.h"
#include "engine/core/sequence.h"
#include "server/sequences/sequence_parameters.h"

namespace vs {

visionserver::v1::Parameter ToProto(const BlockParameter& parameter);
visionserver::v1::ParameterValue ToProto(const ParamAssignment& assignment);
// INVALID_ARGUMENT with all faults.
Result<std::vector<ParamAssignment>> FromProto(
    const google::protobuf::RepeatedPtrField<visionserver::v1::ParameterValue>& values);

}  // namespace vs
