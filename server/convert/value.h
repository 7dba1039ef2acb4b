#pragma once

#include "visionserver/v1/value.pb.h"

#include "engine/base/status.h"
#include "engine/core/param.h"
#include "engine/core/value.h"

namespace vs {

visionserver::v1::Value ToProto(const ParamValue& value);
// INVALID_ARGUMENT for what no parameter can hold (null, bytes, lists, tables).
Result<ParamValue> ToParamValue(const visionserver::v1::Value& value);

// Numbers, texts, lists and tables; a trigger becomes its time. Pictures and maps, which travel as
// frames instead, become null.
visionserver::v1::Value ToProto(const Value& value);

}  // namespace vs
