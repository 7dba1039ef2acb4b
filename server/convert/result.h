#pragma once

#include "visionserver/v1/result.pb.h"

#include "engine/base/status.h"
#include "server/results/sql_query.h"
#include "server/results/stored_result.h"

namespace vs {

visionserver::v1::Result ToProto(const StoredResult& result);
// INVALID_ARGUMENT for a class that does not exist.
Result<ResultFilter> FromProto(const visionserver::v1::ResultFilter& filter);

visionserver::v1::Table ToProto(const SqlTable& table);
// INVALID_ARGUMENT for lists and tables.
Result<SqlValue> ToSqlValue(const visionserver::v1::Value& value);

}  // namespace vs
