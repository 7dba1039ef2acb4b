#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/status.h"
#include "engine/core/result_sink.h"

namespace vs {

// A result as it lies in the store.
struct StoredResult {
  uint64_t number = 0;  // order of storing, from 1; never used twice, may have gaps
  std::string result_id;
  int64_t creation_time_ns = 0;     // UTC
  int64_t acquisition_time_ns = 0;  // UTC; 0 when there was no camera
  ResultRecord record;              // without capture_ns: that clock ended with its process
};

// What it takes in memory or in a message, rounded up.
size_t SizeBytes(const StoredResult& result);

// Which results are meant; all conditions hold at once.
struct ResultFilter {
  std::string job_id;   // empty = all
  std::string part_id;  // empty = all
  std::optional<ResultRecord::Class> result_class;
  std::optional<ResultRecord::State> result_state;
  std::optional<int64_t> from_ns;   // created at or after, UTC
  std::optional<int64_t> until_ns;  // created before, UTC
};

// "completed" and the like, as stored.
std::string_view ResultStateName(ResultRecord::State state);
ResultRecord::State ResultStateOf(std::string_view name);
// "undefined", "pass", "warn", "fail".
std::string_view ResultClassName(ResultRecord::Class result_class);
ResultRecord::Class ResultClassOf(std::string_view name);
// 16 hexadecimal digits.
std::string ParameterHashText(uint64_t hash);

// The measured values as one JSON object. What JSON cannot say (infinity, NaN) becomes null.
std::string FieldsToJson(const std::map<std::string, ParamValue>& fields);
// Null values are left out.
std::map<std::string, ParamValue> FieldsFromJson(std::string_view json);

}  // namespace vs
