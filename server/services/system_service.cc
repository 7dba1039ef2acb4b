#include "server/services/system_service.h"

#include <set>
#include <string>
#include <utility>

#include "server/convert/time.h"
#include "server/services/gpus.h"
#include "server/services/resources.h"

namespace vs {

namespace pb = visionserver::v1;

SystemService::SystemService(const SystemServiceOptions& options, const Clock& clock,
                             AccessControl& access, const AlarmBoard& alarms)
    : options_(options),
      clock_(clock),
      access_(access),
      alarms_(alarms),
      started_ns_(clock.MonotonicNs()),
      started_utc_ns_(clock.UtcNs()) {}

void SystemService::Register(Router& router) {
  const std::string prefix = "/visionserver.v1.SystemService/";
  router.Unary(prefix + "GetServerInfo", this, &SystemService::GetServerInfo,
               {.lane = Lane::kInline, .max_request_bytes = 1024});
  router.Unary(prefix + "GetStatistics", this, &SystemService::GetStatistics);
  router.Unary(prefix + "GetResources", this, &SystemService::GetResources);
  router.Unary(prefix + "ListAlarms", this, &SystemService::ListAlarms);
}

void SystemService::Attach(const Dispatcher& dispatcher,
                           std::function<Acceptor::Stats()> connections) {
  dispatcher_ = &dispatcher;
  connections_ = std::move(connections);
}

Result<pb::GetServerInfoResponse> SystemService::GetServerInfo(
    const Call& call, const pb::GetServerInfoRequest& /*request*/) {
  pb::GetServerInfoResponse response;
  response.set_product("VisionServer");
  response.set_name(options_.name);
  response.set_api_version("v1");
  *response.mutable_time() = ToTimestamp(clock_.UtcNs());
  response.set_monotonic_ns(clock_.MonotonicNs());
  // Strangers need not know which faults this version may have.
  if (call.caller.kind != Caller::Kind::kNobody) response.set_version(options_.version);
  return response;
}

Result<pb::GetStatisticsResponse> SystemService::GetStatistics(
    const Call& /*call*/, const pb::GetStatisticsRequest& /*request*/) {
  pb::GetStatisticsResponse response;
  *response.mutable_started() = ToTimestamp(started_utc_ns_);
  *response.mutable_uptime() = ToDuration(clock_.MonotonicNs() - started_ns_);
  const Acceptor::Stats connections = connections_();
  response.set_connections(connections.open);
  response.set_connections_accepted(connections.accepted);
  response.set_connections_refused(connections.refused);
  response.set_open_streams(dispatcher_->OpenStreams());
  response.set_sessions(access_.sessions().Count());
  response.set_logins(access_.logins());
  response.set_logins_failed(access_.failed_logins());
  std::set<std::string> online;
  for (const SessionInfo& session : access_.sessions().List("")) online.insert(session.record.user);
  for (const std::string& user : online) response.add_users_online(user);
  for (const MethodStats& stats : dispatcher_->Statistics()) {
    pb::MethodStatistics* method = response.add_methods();
    method->set_method(stats.method);
    method->set_succeeded(stats.succeeded);
    method->set_failed(stats.failed);
    method->set_mean_us(stats.mean_us);
    method->set_max_us(stats.max_us);
  }
  return response;
}

Result<pb::GetResourcesResponse> SystemService::GetResources(
    const Call& /*call*/, const pb::GetResourcesRequest& /*request*/) {
  const Resources resources = ReadResources(options_.data_dir);
  pb::GetResourcesResponse response;
  response.set_cpu_cores(resources.cpu_cores);
  *response.mutable_cpu_time() = ToDuration(resources.cpu_time_ns);
  response.set_load_1min(resources.load_1min);
  response.set_memory_total_bytes(resources.memory_total_bytes);
  response.set_memory_available_bytes(resources.memory_available_bytes);
  response.set_memory_server_bytes(resources.memory_server_bytes);
  response.set_disk_total_bytes(resources.disk_total_bytes);
  response.set_disk_free_bytes(resources.disk_free_bytes);
  response.set_open_files(resources.open_files);
  response.set_open_files_limit(resources.open_files_limit);
  AddGpus(gpu::Devices(), &response);
  return response;
}

Result<pb::ListAlarmsResponse> SystemService::ListAlarms(const Call& /*call*/,
                                                         const pb::ListAlarmsRequest& /*request*/) {
  pb::ListAlarmsResponse response;
  for (const AlarmBoard::Alarm& alarm : alarms_.List()) {
    pb::Alarm* added = response.add_alarms();
    added->set_id(alarm.id);
    added->set_severity(alarm.severity == AlarmBoard::Severity::kError
                            ? pb::ALARM_SEVERITY_ERROR
                            : pb::ALARM_SEVERITY_WARNING);
    added->set_message(alarm.message);
    *added->mutable_since() = ToTimestamp(alarm.since_utc_ns);
  }
  return response;
}

}  // namespace vs
