#include "server/convert/sequence.h"

#include <utility>
#include <vector>

#include "engine/base/str.h"
#include "engine/core/block.h"
#include "server/convert/time.h"
#include "server/convert/value.h"

namespace vs {
namespace {

namespace pb = visionserver::v1;

constexpr double kNsPerUs = 1000;

double ToUs(int64_t ns) { return static_cast<double>(ns) / kNsPerUs; }

// "block.port" in its two parts.
bool Split(const std::string& end, std::string* block, std::string* port) {
  const size_t dot = end.find('.');
  if (dot == std::string::npos) return false;
  *block = end.substr(0, dot);
  *port = end.substr(dot + 1);
  return true;
}

BlockSpec FromProto(const pb::BlockSpec& block, std::vector<Fault>* faults) {
  BlockSpec result{.id = block.id(), .type = block.type(), .x = block.x(), .y = block.y()};
  for (const auto& [name, value] : block.parameters()) {
    Result<ParamValue> converted = ToParamValue(value);
    if (converted) {
      result.params[name] = std::move(*converted);
    } else {
      faults->push_back({block.id() + "." + name, converted.error().message()});
    }
  }
  return result;
}

pb::PortInfo ToProto(const PortInfo& info) {
  pb::PortInfo port;
  port.set_name(info.name);
  port.set_type(std::string(info.type));
  port.set_doc(info.doc);
  port.set_optional(!info.output && info.need != Need::kRequired);
  return port;
}

pb::BlockState ToProto(const BlockStats& stats) {
  pb::BlockState state;
  state.set_block(stats.id);
  state.set_runs(stats.runs);
  state.set_failures(stats.errors);
  state.set_skipped(stats.skipped);
  state.set_last_us(ToUs(stats.last_ns));
  state.set_p50_us(ToUs(stats.p50_ns));
  state.set_p99_us(ToUs(stats.p99_ns));
  state.set_last_error(stats.last_error);
  state.set_last_failure(stats.last_failure);
  for (const Reading& reading : stats.readings) {
    pb::Reading* added = state.add_readings();
    added->set_name(reading.name);
    *added->mutable_value() = vs::ToProto(reading.value);
  }
  return state;
}

pb::ParameterType TypeOf(const ParamInfo& info) {
  if (!info.choices.empty()) return pb::PARAMETER_TYPE_CHOICE;
  constexpr pb::ParameterType kTypes[] = {pb::PARAMETER_TYPE_BOOL, pb::PARAMETER_TYPE_INT,
                                          pb::PARAMETER_TYPE_DOUBLE, pb::PARAMETER_TYPE_STRING};
  return kTypes[info.initial.index()];
}

}  // namespace

pb::SequenceSpec ToProto(const SequenceSpec& spec) {
  pb::SequenceSpec result;
  result.set_description(spec.description);
  result.set_priority(spec.priority);
  result.set_max_frames_in_flight(static_cast<uint32_t>(spec.max_frames_in_flight));
  result.set_latency_budget_ms(spec.latency_budget_ms);
  for (const BlockSpec& block : spec.blocks) {
    pb::BlockSpec* added = result.add_blocks();
    added->set_id(block.id);
    added->set_type(block.type);
    added->set_x(block.x);
    added->set_y(block.y);
    for (const auto& [name, value] : block.params) {
      (*added->mutable_parameters())[name] = ToProto(value);
    }
  }
  for (const Connection& connection : spec.connections) {
    pb::Connection* added = result.add_connections();
    added->set_from(connection.from_block + "." + connection.from_port);
    added->set_to(connection.to_block + "." + connection.to_port);
  }
  return result;
}

Result<SequenceSpec> FromProto(const std::string& id, const pb::SequenceSpec& spec) {
  SequenceSpec result;
  result.id = id;
  result.description = spec.description();
  result.priority = spec.priority();
  if (spec.max_frames_in_flight() != 0) {
    result.max_frames_in_flight = static_cast<int>(spec.max_frames_in_flight());
  }
  result.latency_budget_ms = spec.latency_budget_ms();
  std::vector<Fault> faults;
  for (const pb::BlockSpec& block : spec.blocks()) {
    result.blocks.push_back(FromProto(block, &faults));
  }
  for (const pb::Connection& connection : spec.connections()) {
    Connection converted;
    if (Split(connection.from(), &converted.from_block, &converted.from_port) &&
        Split(connection.to(), &converted.to_block, &converted.to_port)) {
      result.connections.push_back(std::move(converted));
    } else {
      faults.push_back({"sequence", Str("the connection from ", Quoted(connection.from()), " to ",
                                        Quoted(connection.to()),
                                        " must name a block and a port at both ends, such as "
                                        "\"match.left\"")});
    }
  }
  if (faults.empty()) return result;
  std::string first = faults.front().subject + ": " + faults.front().message;
  return Status(StatusCode::kInvalidArgument, std::move(first), std::move(faults));
}

pb::Sequence ToProto(const StoredSequence& stored, const SequenceStatus& status, bool with_spec) {
  pb::Sequence result;
  result.set_id(stored.spec.id);
  if (with_spec) *result.mutable_spec() = ToProto(stored.spec);
  result.set_revision(stored.revision);
  result.set_etag(stored.etag);
  if (stored.created_ns != 0) *result.mutable_created() = ToTimestamp(stored.created_ns);
  if (stored.updated_ns != 0) *result.mutable_updated() = ToTimestamp(stored.updated_ns);
  result.set_updated_by(stored.updated_by);
  result.set_run_state(ToProto(status.activity));
  result.set_running_revision(status.revision);
  result.set_autostart(stored.autostart);
  return result;
}

pb::SequenceRunState ToProto(Activity activity) {
  switch (activity) {
    case Activity::kStopped:
      return pb::SEQUENCE_RUN_STATE_STOPPED;
    case Activity::kStarting:
      return pb::SEQUENCE_RUN_STATE_STARTING;
    case Activity::kRunning:
      return pb::SEQUENCE_RUN_STATE_RUNNING;
    case Activity::kDegraded:
      return pb::SEQUENCE_RUN_STATE_DEGRADED;
    case Activity::kStopping:
      return pb::SEQUENCE_RUN_STATE_STOPPING;
    case Activity::kFault:
      return pb::SEQUENCE_RUN_STATE_FAULT;
  }
  return pb::SEQUENCE_RUN_STATE_UNSPECIFIED;
}

pb::SequenceState ToProto(const SequenceStatus& status) {
  pb::SequenceState state;
  state.set_sequence(status.id);
  state.set_state(ToProto(status.activity));
  state.set_revision(status.revision);
  if (status.started_ns != 0) *state.mutable_started() = ToTimestamp(status.started_ns);
  const RunStats& stats = status.stats;
  state.set_frames_per_second(stats.frames_per_second);
  state.set_frames(stats.frames);
  state.set_dropped(stats.dropped);
  state.set_failed(stats.failed_frames);
  state.set_in_flight(static_cast<uint32_t>(stats.frames_in_flight));
  state.set_latency_p50_us(ToUs(stats.latency_p50_ns));
  state.set_latency_p99_us(ToUs(stats.latency_p99_ns));
  state.set_latency_budget_ms(stats.latency_budget_ms);
  state.set_over_budget(stats.over_budget);
  for (const BlockStats& block : stats.blocks) *state.add_blocks() = ToProto(block);
  if (!status.error.empty()) {
    pb::SequenceError* error = state.mutable_last_error();
    error->set_path(status.error_block.empty() ? status.id : status.id + "/" + status.error_block);
    error->set_message(status.error);
    *error->mutable_time() = ToTimestamp(status.error_ns);
  }
  return state;
}

pb::ParameterInfo ToProto(const ParamInfo& info) {
  pb::ParameterInfo result;
  result.set_name(info.name);
  result.set_type(TypeOf(info));
  result.set_doc(info.doc);
  result.set_unit(info.unit);
  *result.mutable_initial() = ToProto(info.initial);
  if (info.min) result.set_min(*info.min);
  if (info.max) result.set_max(*info.max);
  for (const std::string& choice : info.choices) result.add_choices(choice);
  result.set_operator_editable(info.operator_editable);
  result.set_fixed_while_running(!info.live);
  return result;
}

pb::BlockType ToProto(const BlockRegistry::Entry& entry) {
  pb::BlockType result;
  result.set_type(entry.type);
  result.set_category(entry.info.category);
  result.set_doc(entry.info.doc);
  const std::unique_ptr<Block> block = entry.make();
  for (const PortBase* port : block->inputs()) *result.add_inputs() = ToProto(port->info());
  for (const PortBase* port : block->outputs()) *result.add_outputs() = ToProto(port->info());
  for (const ParamBase* param : block->params()) {
    *result.add_parameters() = ToProto(param->info());
  }
  return result;
}

pb::Fault ToProto(const Fault& fault) {
  pb::Fault result;
  result.set_subject(fault.subject);
  result.set_message(fault.message);
  return result;
}

}  // namespace vs
