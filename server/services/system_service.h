#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "visionserver/v1/system.pb.h"

#include "engine/base/clock.h"
#include "engine/base/status.h"
#include "server/access/access_control.h"
#include "server/rpc/dispatcher.h"
#include "server/rpc/router.h"
#include "server/services/alarm_board.h"
#include "server/transport/acceptor.h"

namespace vs {

struct SystemServiceOptions {
  std::string name;     // of this server
  std::string version;  // of the program
  std::filesystem::path data_dir;
};

// The server itself: see system.proto.
class SystemService {
 public:
  SystemService(const SystemServiceOptions& options, const Clock& clock, AccessControl& access,
                const AlarmBoard& alarms);
  void Register(Router& router);

  // Where calls and connections are counted. Before the first call; both outlive the service's use.
  void Attach(const Dispatcher& dispatcher, std::function<Acceptor::Stats()> connections);

 private:
  Result<visionserver::v1::GetServerInfoResponse> GetServerInfo(
      const Call& call, const visionserver::v1::GetServerInfoRequest& request);
  Result<visionserver::v1::GetStatisticsResponse> GetStatistics(
      const Call& call, const visionserver::v1::GetStatisticsRequest& request);
  Result<visionserver::v1::GetResourcesResponse> GetResources(
      const Call& call, const visionserver::v1::GetResourcesRequest& request);
  Result<visionserver::v1::ListAlarmsResponse> ListAlarms(
      const Call& call, const visionserver::v1::ListAlarmsRequest& request);

  const SystemServiceOptions options_;
  const Clock& clock_;
  AccessControl& access_;
  const AlarmBoard& alarms_;
  const int64_t started_ns_;
  const int64_t started_utc_ns_;
  const Dispatcher* dispatcher_ = nullptr;
  std::function<Acceptor::Stats()> connections_;
};

}  // namespace vs
