#include "server/convert/camera.h"

#include <utility>
#include <variant>

#include "server/convert/value.h"

namespace vs {
namespace {

namespace pb = visionserver::v1;

pb::CameraState ToProto(CameraState state) {
  switch (state) {
    case CameraState::kClosed:
      return pb::CAMERA_STATE_CLOSED;
    case CameraState::kOpening:
      return pb::CAMERA_STATE_OPENING;
    case CameraState::kIdle:
      return pb::CAMERA_STATE_IDLE;
    case CameraState::kStreaming:
      return pb::CAMERA_STATE_STREAMING;
    case CameraState::kStalled:
      return pb::CAMERA_STATE_STALLED;
    case CameraState::kLost:
      return pb::CAMERA_STATE_LOST;
  }
  return pb::CAMERA_STATE_UNSPECIFIED;
}

pb::CameraCounters CountersOf(const CameraStats& stats) {
  pb::CameraCounters counters;
  counters.set_frames(stats.frames);
  counters.set_incomplete(stats.incomplete);
  counters.set_rejected_stale(stats.rejected_stale);
  counters.set_lost(stats.lost);
  counters.set_underruns(stats.underruns);
  counters.set_resend_requests(stats.resend_requests);
  counters.set_resent(stats.resent);
  counters.set_reconnects(stats.reconnects);
  counters.set_socket_buffer_asked_bytes(static_cast<uint64_t>(stats.socket_buffer_asked_bytes));
  counters.set_socket_buffer_got_bytes(static_cast<uint64_t>(stats.socket_buffer_got_bytes));
  counters.set_packet_bytes(static_cast<uint32_t>(stats.packet_bytes));
  counters.set_frames_per_second(stats.frames_per_second);
  return counters;
}

pb::FeatureType ToProto(FeatureInfo::Type type) {
  switch (type) {
    case FeatureInfo::Type::kBoolean:
      return pb::FEATURE_TYPE_BOOLEAN;
    case FeatureInfo::Type::kInteger:
      return pb::FEATURE_TYPE_INTEGER;
    case FeatureInfo::Type::kFloat:
      return pb::FEATURE_TYPE_FLOAT;
    case FeatureInfo::Type::kString:
      return pb::FEATURE_TYPE_STRING;
    case FeatureInfo::Type::kEnumeration:
      return pb::FEATURE_TYPE_ENUMERATION;
    case FeatureInfo::Type::kCommand:
      return pb::FEATURE_TYPE_COMMAND;
  }
  return pb::FEATURE_TYPE_UNSPECIFIED;
}

}  // namespace

pb::Camera ToProto(const CameraEntry& entry) {
  pb::Camera camera;
  camera.set_id(entry.id);
  camera.set_uri(entry.uri);
  camera.set_vendor_model(entry.stats.model);
  camera.set_serial(entry.stats.serial);
  camera.set_state(ToProto(entry.stats.state));
  camera.set_last_error(entry.stats.last_error);
  *camera.mutable_counters() = CountersOf(entry.stats);
  for (const std::string& sequence : entry.used_by) camera.add_used_by(sequence);
  return camera;
}

pb::FeatureInfo ToProto(const FeatureInfo& info) {
  pb::FeatureInfo result;
  result.set_name(info.name);
  result.set_type(ToProto(info.type));
  result.set_unit(info.unit);
  result.set_description(info.description);
  result.set_writable(info.writable);
  if (info.min) result.set_min(*info.min);
  if (info.max) result.set_max(*info.max);
  for (const std::string& choice : info.choices) result.add_choices(choice);
  return result;
}

// Features hold what parameters hold.
static_assert(std::is_same_v<FeatureValue, ParamValue>);

pb::FeatureValue ToProto(const std::string& name, const FeatureValue& value) {
  pb::FeatureValue result;
  result.set_name(name);
  *result.mutable_value() = ToProto(value);
  return result;
}

Result<FeatureValue> FromProto(const pb::FeatureValue& value) {
  Result<FeatureValue> converted = ToParamValue(value.value());
  if (!converted) return converted.error().Annotated(value.name());
  return converted;
}

}  // namespace vs
