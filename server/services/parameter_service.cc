#include "server/services/parameter_service.h"

#include <set>
#include <utility>

#include "engine/base/log.h"
#include "engine/base/str.h"
#include "server/convert/parameter.h"
#include "server/services/parameter_source.h"

namespace vs {
namespace {

namespace pb = visionserver::v1;

constexpr int kMaxValues = 1000;
constexpr size_t kMaxReasonBytes = 256;

pb::SetParametersResponse ToProto(const ParameterAnswer& answer) {
  pb::SetParametersResponse response;
  response.set_applied_at_frame(answer.applied_at_frame);
  for (const ParamAssignment& value : answer.values) *response.add_values() = vs::ToProto(value);
  response.set_etag(answer.etag);
  response.set_revision(answer.revision);
  return response;
}

// Who changed what, and why, for whoever asks later.
void LogChange(const Call& call, const pb::SetParametersRequest& request,
               const ParameterAnswer& answer) {
  std::string changes;
  for (const ParamAssignment& one : answer.values) {
    changes +=
        Str(changes.empty() ? "" : ", ", one.block, '.', one.param, " = ", ToString(one.value));
    if (changes.size() > 500) break;
  }
  LogInfo("parameters", Str(call.caller.name, " set in ", request.sequence(), ": ", changes,
                            request.reason().empty() ? "" : " because: ", request.reason()));
}

}  // namespace

void ParameterService::Register(Router& router) {
  const std::string service = "/visionserver.v1.ParameterService/";
  router.Unary(service + "ListParameters", this, &ParameterService::ListParameters);
  router.Unary(service + "GetParameters", this, &ParameterService::GetParameters);
  router.Unary(service + "SetParameters", this, &ParameterService::SetParameters);
  router.Unary(service + "ResetParameters", this, &ParameterService::ResetParameters);
  router.Stream(service + "WatchParameters", this, &ParameterService::WatchParameters);
}

Result<pb::ListParametersResponse> ParameterService::ListParameters(
    const Call& /*call*/, const pb::ListParametersRequest& request) {
  VS_ASSIGN_OR_RETURN(const ParameterSet set, manager_.Parameters(request.sequence()));
  pb::ListParametersResponse response;
  for (const BlockParameter& parameter : set.parameters) {
    *response.add_parameters() = vs::ToProto(parameter);
  }
  response.set_etag(set.etag);
  return response;
}

Result<pb::GetParametersResponse> ParameterService::GetParameters(
    const Call& /*call*/, const pb::GetParametersRequest& request) {
  VS_ASSIGN_OR_RETURN(const ParameterSet set, manager_.Parameters(request.sequence()));
  std::set<std::string> wanted(request.paths().begin(), request.paths().end());
  const bool all = wanted.empty();
  pb::GetParametersResponse response;
  for (const BlockParameter& parameter : set.parameters) {
    const std::string path = parameter.block + "." + parameter.info().name;
    if (!all && wanted.erase(path) == 0) continue;
    *response.add_values() =
        vs::ToProto(ParamAssignment{parameter.block, parameter.info().name, parameter.value});
  }
  if (!wanted.empty()) {
    return NotFound(
        Str("sequence ", request.sequence(), " has no parameter ", Quoted(*wanted.begin())));
  }
  response.set_etag(set.etag);
  return response;
}

Result<pb::SetParametersResponse> ParameterService::SetParameters(
    const Call& call, const pb::SetParametersRequest& request) {
  if (request.values().empty() || request.values_size() > kMaxValues) {
    return InvalidArgument(
        Str("set 1 to ", kMaxValues, " parameters at once, not ", request.values_size()));
  }
  if (request.reason().size() > kMaxReasonBytes) {
    return InvalidArgument(Str("the reason has at most ", kMaxReasonBytes, " bytes"));
  }
  VS_ASSIGN_OR_RETURN(std::vector<ParamAssignment> values, FromProto(request.values()));
  VS_ASSIGN_OR_RETURN(const ParameterAnswer answer,
                      manager_.SetParameters(request.sequence(),
                                             {.values = std::move(values),
                                              .etag = request.etag(),
                                              .validate_only = request.validate_only(),
                                              .operators_only = !MaySetEveryParameter(call.caller),
                                              .user = call.caller.name}));
  if (!request.validate_only()) LogChange(call, request, answer);
  return ToProto(answer);
}

Result<pb::SetParametersResponse> ParameterService::ResetParameters(
    const Call& call, const pb::ResetParametersRequest& request) {
  const std::vector<std::string> paths(request.paths().begin(), request.paths().end());
  VS_ASSIGN_OR_RETURN(
      const ParameterAnswer answer,
      manager_.ResetParameters(request.sequence(), paths,
                               {.etag = request.etag(),
                                .operators_only = !MaySetEveryParameter(call.caller),
                                .user = call.caller.name}));
  return ToProto(answer);
}

Result<std::unique_ptr<StreamSource>> ParameterService::WatchParameters(
    const Call& /*call*/, const pb::WatchParametersRequest& request) {
  if (const auto set = manager_.Parameters(request.sequence()); !set) return set.error();
  return std::make_unique<ParameterSource>(manager_, request.sequence());
}

}  // namespace vs
