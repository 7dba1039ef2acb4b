#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "engine/base/status.h"
#include "engine/core/param.h"

namespace vs {

// One inspection result with the names of OPC 40100-1 (ResultDataType).
struct ResultRecord {
  enum class State { kCompleted, kAborted, kFailed };    // of the measurement itself
  enum class Class { kUndefined, kPass, kWarn, kFail };  // what it says about the part

  std::string job_id;   // the sequence
  std::string part_id;  // empty = unknown
  std::string meas_id;  // free; empty = none
  uint64_t sequence_revision = 0;
  uint64_t parameter_hash = 0;  // of all parameter values in effect
  uint64_t frame_number = 0;
  int64_t capture_ns = 0;     // monotonic; the store adds wall time
  int64_t processing_ns = 0;  // from the source block to the log block
  State state = State::kCompleted;
  Class result_class = Class::kUndefined;
  std::string reason;                        // in words, when failed
  std::map<std::string, ParamValue> values;  // measured values by name
};

// Where blocks log results. Thread-safe; never blocks on the disk.
class ResultSink {
 public:
  virtual ~ResultSink() = default;
  // The result's id (UUIDv7). RESOURCE_EXHAUSTED when the store cannot keep up: nothing was
  // logged, and the caller must say so.
  virtual Result<std::string> Log(ResultRecord record) = 0;
};

}  // namespace vs
