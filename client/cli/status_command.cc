#include "visionserver/v1/system.grpc.pb.h"

#include "client/cli/command.h"

namespace vs::cli {
namespace {

std::string Mebibytes(uint64_t bytes) {
  return NumberText(static_cast<double>(bytes) / (1 << 20), 0) + " MiB";
}

void Print(const v1::GetServerInfoResponse& info, const v1::GetStatisticsResponse& statistics,
           const v1::GetResourcesResponse& resources, const v1::ListAlarmsResponse& alarms) {
  PrintLine(info.name() + ", VisionServer " + info.version() + ", up since " +
            TimeText(statistics.started()));
  PrintLine("sessions " + std::to_string(statistics.sessions()) + ", connections " +
            std::to_string(statistics.connections()) + ", open streams " +
            std::to_string(statistics.open_streams()));
  PrintLine("processor: load " + NumberText(resources.load_1min(), 2) + " on " +
            std::to_string(resources.cpu_cores()) +
            " cores; memory: " + Mebibytes(resources.memory_server_bytes()) +
            ", free on the machine " + Mebibytes(resources.memory_available_bytes()) +
            "; free on the disk " + Mebibytes(resources.disk_free_bytes()));
  for (int k = 0; k < resources.gpus_size(); ++k) {
    const v1::Gpu& gpu = resources.gpus(k);
    PrintLine("GPU " + std::to_string(k) + ": " + gpu.name() + ", " +
              Mebibytes(gpu.memory_bytes()) + ", compute capability " + gpu.compute_capability() +
              ", driver for CUDA " + gpu.driver_cuda_version());
  }
  if (!resources.no_gpu_reason().empty()) PrintLine("no GPU: " + resources.no_gpu_reason());
  for (const v1::Alarm& alarm : alarms.alarms()) {
    PrintLine(std::string(alarm.severity() == v1::ALARM_SEVERITY_ERROR ? "ERROR" : "WARNING") +
              " since " + TimeText(alarm.since()) + ": " + alarm.message());
  }
  if (alarms.alarms().empty()) PrintLine("no alarms");
}

Result<void> Status(Session& session) {
  using Stub = v1::SystemService::Stub;
  VS_CLI_TRY(const auto info, Ask(session, &Stub::GetServerInfo, {}));
  VS_CLI_TRY(const auto statistics, Ask(session, &Stub::GetStatistics, {}));
  VS_CLI_TRY(const auto resources, Ask(session, &Stub::GetResources, {}));
  VS_CLI_TRY(const auto alarms, Ask(session, &Stub::ListAlarms, {}));
  if (session.options().json) {
    PrintJsonObject({{"info", &info},
                     {"statistics", &statistics},
                     {"resources", &resources},
                     {"alarms", &alarms}});
  } else {
    Print(info, statistics, resources, alarms);
  }
  return {};
}

}  // namespace

void AddStatusCommand(CommandLine& line) {
  line.Add("status", "Show how the server is: load, connections, alarms").Run(Status);
}

}  // namespace vs::cli
