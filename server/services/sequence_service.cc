#include "server/services/sequence_service.h"

#include <algorithm>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/str.h"
#include "engine/core/check_sequence.h"
#include "engine/core/registry.h"
#include "server/convert/sequence.h"
#include "server/services/periodic_source.h"

namespace vs {
namespace {

namespace pb = visionserver::v1;

Status CheckUnlessAllowed(const SequenceSpec& spec, bool allow_faults) {
  if (allow_faults) return Status();
  std::vector<Fault> faults = CheckSequence(spec);
  if (faults.empty()) return Status();
  const std::string first = faults.front().subject + ": " + faults.front().message;
  std::string message =
      faults.size() == 1 ? "the sequence has a fault: " + first
                         : Str("the sequence has ", faults.size(), " faults, the first is ", first);
  return Status(StatusCode::kInvalidArgument, std::move(message), std::move(faults));
}

// Which parts of a sequence an update replaces.
struct UpdateParts {
  bool autostart = false;
  std::set<std::string> spec;  // fields of SequenceSpec
};

Result<UpdateParts> PartsOf(const google::protobuf::FieldMask& mask) {
  static const std::set<std::string> spec_fields = {"description",          "blocks",
                                                    "connections",          "priority",
                                                    "max_frames_in_flight", "latency_budget_ms"};
  if (mask.paths().empty()) return UpdateParts{true, spec_fields};
  UpdateParts parts;
  for (const std::string& path : mask.paths()) {
    if (path == "autostart") {
      parts.autostart = true;
    } else if (path == "spec") {
      parts.spec = spec_fields;
    } else if (path.starts_with("spec.") && spec_fields.contains(path.substr(5))) {
      parts.spec.insert(path.substr(5));
    } else {
      return InvalidArgument(Str("update_mask names ", Quoted(path),
                                 "; it may name autostart, spec and the fields of spec"));
    }
  }
  return parts;
}

void Replace(const std::set<std::string>& fields, SequenceSpec from, SequenceSpec* to) {
  if (fields.contains("description")) to->description = std::move(from.description);
  if (fields.contains("blocks")) to->blocks = std::move(from.blocks);
  if (fields.contains("connections")) to->connections = std::move(from.connections);
  if (fields.contains("priority")) to->priority = from.priority;
  if (fields.contains("max_frames_in_flight")) {
    to->max_frames_in_flight = from.max_frames_in_flight;
  }
  if (fields.contains("latency_budget_ms")) to->latency_budget_ms = from.latency_budget_ms;
}

Observation Observe(const SequenceStatus& status) {
  return {.id = status.id,
          .changes = Str(static_cast<int>(status.activity), ' ', status.revision, ' ',
                         status.error_block, ' ', status.error),
          .message = Serialize(ToProto(status))};
}

}  // namespace

SequenceService::SequenceService(SequenceStore& store, SequenceManager& manager, const Clock& clock)
    : store_(store),
      manager_(manager),
      states_(clock,
              [&manager] {
                SharedObservations::List states;
                for (const SequenceStatus& status : manager.List()) {
                  states.push_back(Observe(status));
                }
                return states;
              }),
      listening_(manager.changed().Add([this](const std::string&) { states_.Renew(); })) {}

void SequenceService::Register(Router& router) {
  const std::string service = "/visionserver.v1.SequenceService/";
  router.Unary(service + "ListSequences", this, &SequenceService::ListSequences);
  router.Unary(service + "GetSequence", this, &SequenceService::GetSequence);
  router.Unary(service + "CreateSequence", this, &SequenceService::CreateSequence);
  router.Unary(service + "UpdateSequence", this, &SequenceService::UpdateSequence);
  router.Unary(service + "DeleteSequence", this, &SequenceService::DeleteSequence);
  router.Unary(service + "ValidateSequence", this, &SequenceService::ValidateSequence);
  router.Unary(service + "ListBlockTypes", this, &SequenceService::ListBlockTypes);
  // These wait for blocks.
  router.Unary(service + "StartSequence", this, &SequenceService::StartSequence,
               {.lane = Lane::kSlow});
  router.Unary(service + "StopSequence", this, &SequenceService::StopSequence,
               {.lane = Lane::kSlow});
  router.Unary(service + "GetSequenceState", this, &SequenceService::GetSequenceState);
  router.Stream(service + "WatchSequence", this, &SequenceService::WatchSequence);
}

Result<pb::ListSequencesResponse> SequenceService::ListSequences(
    const Call& /*call*/, const pb::ListSequencesRequest& /*request*/) {
  pb::ListSequencesResponse response;
  for (const StoredSequence& stored : store_.List()) {
    *response.add_sequences() = Described(stored, false);
  }
  return response;
}

Result<pb::Sequence> SequenceService::GetSequence(const Call& /*call*/,
                                                  const pb::GetSequenceRequest& request) {
  VS_ASSIGN_OR_RETURN(const StoredSequence stored, store_.Get(request.id()));
  return Described(stored, true);
}

Result<pb::Sequence> SequenceService::CreateSequence(const Call& call,
                                                     const pb::CreateSequenceRequest& request) {
  VS_ASSIGN_OR_RETURN(const SequenceSpec spec, FromProto(request.id(), request.spec()));
  VS_RETURN_IF_ERROR(CheckUnlessAllowed(spec, request.allow_faults()));
  VS_ASSIGN_OR_RETURN(const StoredSequence stored,
                      store_.Create(spec, request.autostart(), call.caller.name));
  return Described(stored, true);
}

Result<pb::Sequence> SequenceService::UpdateSequence(const Call& call,
                                                     const pb::UpdateSequenceRequest& request) {
  if (request.etag().empty()) {
    return InvalidArgument(
        "etag is missing: get the sequence, change it, and send the etag that came with it");
  }
  VS_ASSIGN_OR_RETURN(const UpdateParts parts, PartsOf(request.update_mask()));
  VS_ASSIGN_OR_RETURN(const SequenceSpec spec, FromProto(request.id(), request.spec()));
  const auto change = [&](StoredSequence* stored) {
    Replace(parts.spec, spec, &stored->spec);
    if (parts.autostart) stored->autostart = request.autostart();
    return CheckUnlessAllowed(stored->spec, request.allow_faults());
  };
  VS_ASSIGN_OR_RETURN(const StoredSequence stored,
                      store_.Update(request.id(), request.etag(), call.caller.name, change));
  manager_.NoteEdited(stored);
  return Described(stored, true);
}

Result<pb::DeleteSequenceResponse> SequenceService::DeleteSequence(
    const Call& /*call*/, const pb::DeleteSequenceRequest& request) {
  VS_RETURN_IF_ERROR(manager_.Delete(request.id(), request.etag()));
  return pb::DeleteSequenceResponse();
}

Result<pb::ValidateSequenceResponse> SequenceService::ValidateSequence(
    const Call& /*call*/, const pb::ValidateSequenceRequest& request) {
  std::vector<Fault> faults;
  if (request.subject_case() == pb::ValidateSequenceRequest::kId) {
    VS_ASSIGN_OR_RETURN(const StoredSequence stored, store_.Get(request.id()));
    faults = CheckSequence(stored.spec);
  } else if (const auto spec = FromProto("validated", request.spec())) {
    faults = CheckSequence(*spec);
  } else {
    faults = spec.error().faults();
  }
  pb::ValidateSequenceResponse response;
  for (const Fault& fault : faults) *response.add_faults() = ToProto(fault);
  return response;
}

Result<pb::ListBlockTypesResponse> SequenceService::ListBlockTypes(
    const Call& /*call*/, const pb::ListBlockTypesRequest& /*request*/) {
  std::vector<const BlockRegistry::Entry*> entries = BlockRegistry::Get().All();
  std::stable_sort(entries.begin(), entries.end(), [](const auto* a, const auto* b) {
    return a->info.category < b->info.category;
  });
  pb::ListBlockTypesResponse response;
  for (const auto* entry : entries) *response.add_block_types() = ToProto(*entry);
  return response;
}

Result<pb::SequenceState> SequenceService::StartSequence(const Call& /*call*/,
                                                         const pb::StartSequenceRequest& request) {
  VS_RETURN_IF_ERROR(manager_.Start(request.id()));
  return StateOf(request.id());
}

Result<pb::SequenceState> SequenceService::StopSequence(const Call& /*call*/,
                                                        const pb::StopSequenceRequest& request) {
  VS_RETURN_IF_ERROR(manager_.Stop(request.id()));
  return StateOf(request.id());
}

Result<pb::SequenceState> SequenceService::GetSequenceState(
    const Call& /*call*/, const pb::GetSequenceStateRequest& request) {
  return StateOf(request.id());
}

Result<std::unique_ptr<StreamSource>> SequenceService::WatchSequence(
    const Call& /*call*/, const pb::WatchSequenceRequest& request) {
  const std::string& id = request.id();
  if (!id.empty()) {
    if (const auto status = manager_.Look(id); !status) return status.error();
    states_.Renew();  // it may be newer than the last look at all
  }
  const auto listen = [this](std::function<void()> wake) {
    return manager_.changed().Add([wake = std::move(wake)](const std::string&) { wake(); });
  };
  return PeriodicSource::Make(states_,
                              {.interval_ms = request.interval_ms(), .id = id, .listen = listen});
}

pb::Sequence SequenceService::Described(const StoredSequence& stored, bool with_spec) {
  // Deleted a moment ago: what is known is still told.
  const SequenceStatus status =
      manager_.Look(stored.spec.id).value_or(SequenceStatus{.id = stored.spec.id});
  return ToProto(stored, status, with_spec);
}

Result<pb::SequenceState> SequenceService::StateOf(const std::string& id) {
  VS_ASSIGN_OR_RETURN(const SequenceStatus status, manager_.Look(id));
  return ToProto(status);
}

}  // namespace vs
