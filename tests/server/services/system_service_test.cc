#include <gmock/gmock.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include "grpc/health/v1/health.grpc.pb.h"
#include "grpc/reflection/v1alpha/reflection.grpc.pb.h"
#include "visionserver/v1/session.grpc.pb.h"
#include "visionserver/v1/system.grpc.pb.h"
#include <google/protobuf/descriptor.pb.h>

#include "server/services/gpus.h"
#include "server/vision_watch.h"
#include "tests/support/client_call.h"
#include "tests/support/fake_clock.h"
#include "tests/support/raw_call.h"
#include "tests/support/test_server.h"
#include "tests/support/wait_until.h"

namespace vs {
namespace {

namespace health = grpc::health::v1;
namespace pb = visionserver::v1;
namespace reflection = grpc::reflection::v1alpha;
using test::ClientCall;
using test::TestServer;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

// The services about the server itself, over the network.
class SystemServiceTest : public ::testing::Test {
 protected:
  TestServer server_{{.config = "name: \"cell 7\" profile: DEVELOPMENT"}};
  std::shared_ptr<grpc::Channel> channel_ = server_.Connect();
  std::unique_ptr<pb::SystemService::Stub> system_ = pb::SystemService::NewStub(channel_);
  std::unique_ptr<health::Health::Stub> health_ = health::Health::NewStub(channel_);
};

TEST_F(SystemServiceTest, TellsStrangersNoVersion) {
  pb::GetServerInfoResponse info;
  ASSERT_TRUE(system_->GetServerInfo(ClientCall("").context(), {}, &info).ok());
  EXPECT_EQ(info.product(), "VisionServer");
  EXPECT_EQ(info.name(), "cell 7");
  EXPECT_EQ(info.api_version(), "v1");
  EXPECT_GT(info.monotonic_ns(), 0);
  EXPECT_EQ(info.version(), "");
  ASSERT_TRUE(
      system_->GetServerInfo(ClientCall(server_.Token(Role::kViewer)).context(), {}, &info).ok());
  EXPECT_NE(info.version(), "");
}

TEST_F(SystemServiceTest, CountsCallsAndConnections) {
  const std::string token = server_.Token(Role::kViewer);
  pb::GetServerInfoResponse info;
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(system_->GetServerInfo(ClientCall("").context(), {}, &info).ok());
  }
  pb::GetStatisticsResponse statistics;
  ASSERT_TRUE(system_->GetStatistics(ClientCall(token).context(), {}, &statistics).ok());
  EXPECT_EQ(statistics.connections(), 1U);
  EXPECT_EQ(statistics.connections_accepted(), 1U);
  EXPECT_EQ(statistics.sessions(), 1U);
  EXPECT_EQ(statistics.logins(), 1U);
  ASSERT_GE(statistics.methods_size(), 1);
  EXPECT_EQ(statistics.methods(0).method(), "/visionserver.v1.SystemService/GetServerInfo");
  EXPECT_EQ(statistics.methods(0).succeeded(), 3U);
  EXPECT_GE(statistics.methods(0).max_us(), statistics.methods(0).mean_us());
}

TEST_F(SystemServiceTest, TellsEverybodyWhoIsOnline) {
  const std::string viewer = server_.Token(Role::kViewer);
  server_.Token(Role::kViewer);  // a second session of the same user
  const std::string engineer = server_.Token(Role::kEngineer);
  const auto online = [&] {
    pb::GetStatisticsResponse statistics;
    EXPECT_TRUE(system_->GetStatistics(ClientCall(viewer).context(), {}, &statistics).ok());
    return std::vector<std::string>(statistics.users_online().begin(),
                                    statistics.users_online().end());
  };
  EXPECT_THAT(online(), ElementsAre("test.engineer", "test.viewer"));
  const auto sessions = pb::SessionService::NewStub(channel_);
  pb::LogoutResponse response;
  ASSERT_TRUE(sessions->Logout(ClientCall(engineer).context(), {}, &response).ok());
  EXPECT_THAT(online(), ElementsAre("test.viewer"));
}

TEST_F(SystemServiceTest, KnowsTheMachine) {
  pb::GetResourcesResponse resources;
  ASSERT_TRUE(
      system_->GetResources(ClientCall(server_.Token(Role::kViewer)).context(), {}, &resources)
          .ok());
  EXPECT_GE(resources.cpu_cores(), 1U);
  EXPECT_GT(resources.cpu_time().seconds() * 1e9 + resources.cpu_time().nanos(), 0);
  EXPECT_GT(resources.memory_total_bytes(), resources.memory_server_bytes());
  EXPECT_GT(resources.memory_server_bytes(), 1'000'000U);
  EXPECT_GE(resources.disk_total_bytes(), resources.disk_free_bytes());
  EXPECT_GT(resources.open_files(), 5U);
  EXPECT_GE(resources.open_files_limit(), resources.open_files());
}

TEST_F(SystemServiceTest, ListsGpusOrSaysWhyThereIsNone) {
  pb::GetResourcesResponse resources;
  ASSERT_TRUE(
      system_->GetResources(ClientCall(server_.Token(Role::kViewer)).context(), {}, &resources)
          .ok());
  EXPECT_NE(resources.gpus().empty(), resources.no_gpu_reason().empty());
}

TEST(Gpus, AreToldWithTheirFigures) {
  pb::GetResourcesResponse resources;
  AddGpus(std::vector<gpu::DeviceInfo>{{.name = "NVIDIA H200",
                                        .memory_bytes = uint64_t{141} << 30,
                                        .compute = "9.0",
                                        .driver = "13.0"},
                                       {.name = "NVIDIA T4"}},
          &resources);
  ASSERT_EQ(resources.gpus_size(), 2);
  EXPECT_EQ(resources.gpus(0).name(), "NVIDIA H200");
  EXPECT_EQ(resources.gpus(0).memory_bytes(), uint64_t{141} << 30);
  EXPECT_EQ(resources.gpus(0).compute_capability(), "9.0");
  EXPECT_EQ(resources.gpus(0).driver_cuda_version(), "13.0");
  EXPECT_EQ(resources.no_gpu_reason(), "");

  resources.Clear();
  AddGpus(Unavailable("no driver"), &resources);
  EXPECT_TRUE(resources.gpus().empty());
  EXPECT_EQ(resources.no_gpu_reason(), "no driver");
}

TEST(Gpus, ThatFailRaiseAnAlarmUntilTheyWorkAgain) {
  TestServer server;
  gpu::DeviceBoard board(2);
  auto seat = *board.Take(1);
  seat.Fails(Unavailable("GPU 1: cudaGraphLaunch: cudaErrorIllegalAddress"));
  test::FakeClock clock;
  AlarmBoard alarms(clock);
  HealthBoard health;
  VisionWatch watch(server->vision(), board, health, alarms, clock);
  ASSERT_TRUE(test::WaitUntil([&] { return !alarms.List().empty(); }));
  EXPECT_EQ(alarms.List()[0].id, "gpu/1");
  EXPECT_EQ(alarms.List()[0].severity, AlarmBoard::Severity::kWarning);
  EXPECT_THAT(alarms.List()[0].message, HasSubstr("GPU 1 does not work"));
  EXPECT_THAT(alarms.List()[0].message, HasSubstr("cudaErrorIllegalAddress"));
  seat.Works();
  ASSERT_TRUE(test::WaitUntil([&] {
    clock.Advance(std::chrono::seconds(5));
    return alarms.List().empty();
  }));
}

TEST_F(SystemServiceTest, ListsAlarmsGravestFirst) {
  server_->alarms().Raise("camera/left", AlarmBoard::Severity::kWarning, "loses packets");
  server_->alarms().Raise("disk", AlarmBoard::Severity::kError, "is full: remove something");
  server_->alarms().Raise("camera/right", AlarmBoard::Severity::kWarning, "gone");
  server_->alarms().Clear("camera/right");
  pb::ListAlarmsResponse list;
  ASSERT_TRUE(
      system_->ListAlarms(ClientCall(server_.Token(Role::kRobot)).context(), {}, &list).ok());
  ASSERT_EQ(list.alarms_size(), 2);
  EXPECT_EQ(list.alarms(0).id(), "disk");
  EXPECT_EQ(list.alarms(0).severity(), pb::ALARM_SEVERITY_ERROR);
  EXPECT_EQ(list.alarms(1).message(), "loses packets");
}

TEST_F(SystemServiceTest, HealthIsKnownWithoutLogin) {
  health::HealthCheckRequest request;
  health::HealthCheckResponse response;
  ASSERT_TRUE(health_->Check(ClientCall("").context(), request, &response).ok());
  EXPECT_EQ(response.status(), health::HealthCheckResponse::SERVING);
  request.set_service("sequences/none");
  EXPECT_EQ(health_->Check(ClientCall("").context(), request, &response).error_code(),
            grpc::StatusCode::NOT_FOUND);
}

TEST_F(SystemServiceTest, HealthOfASequenceCanBeWatched) {
  ClientCall call(server_.Token(Role::kViewer));
  health::HealthCheckRequest request;
  request.set_service("sequences/stereo_depth");
  const auto stream = health_->Watch(call.context(), request);
  health::HealthCheckResponse response;
  ASSERT_TRUE(stream->Read(&response));
  EXPECT_EQ(response.status(), health::HealthCheckResponse::SERVICE_UNKNOWN);
  server_->health().Set("sequences/stereo_depth", true);
  ASSERT_TRUE(stream->Read(&response));
  EXPECT_EQ(response.status(), health::HealthCheckResponse::SERVING);
  server_->health().Set("sequences/stereo_depth", false);
  ASSERT_TRUE(stream->Read(&response));
  EXPECT_EQ(response.status(), health::HealthCheckResponse::NOT_SERVING);
  server_->health().Remove("sequences/stereo_depth");
  ASSERT_TRUE(stream->Read(&response));
  EXPECT_EQ(response.status(), health::HealthCheckResponse::SERVICE_UNKNOWN);
}

TEST_F(SystemServiceTest, DrainSaysSoBeforeTheStreamsEnd) {
  ClientCall call(server_.Token(Role::kViewer));
  const auto stream = health_->Watch(call.context(), {});
  health::HealthCheckResponse response;
  ASSERT_TRUE(stream->Read(&response));
  EXPECT_EQ(response.status(), health::HealthCheckResponse::SERVING);
  std::jthread draining([&] { server_->Drain(); });
  ASSERT_TRUE(stream->Read(&response));
  EXPECT_EQ(response.status(), health::HealthCheckResponse::NOT_SERVING);
  EXPECT_FALSE(stream->Read(&response));
  EXPECT_EQ(stream->Finish().error_code(), grpc::StatusCode::UNAVAILABLE);
}

TEST_F(SystemServiceTest, ReflectionDescribesWhatThereIs) {
  ClientCall call(server_.Token(Role::kEngineer));
  const auto stream =
      reflection::ServerReflection::NewStub(channel_)->ServerReflectionInfo(call.context());
  reflection::ServerReflectionRequest request;
  reflection::ServerReflectionResponse response;
  request.set_list_services("");
  ASSERT_TRUE(stream->Write(request) && stream->Read(&response));
  std::vector<std::string> names;
  for (const auto& service : response.list_services_response().service()) {
    names.push_back(service.name());
  }
  EXPECT_THAT(names, Contains("visionserver.v1.SessionService"));
  EXPECT_THAT(names, Contains("grpc.health.v1.Health"));

  request.set_file_containing_symbol("visionserver.v1.SessionService.Login");
  ASSERT_TRUE(stream->Write(request) && stream->Read(&response));
  google::protobuf::FileDescriptorProto file;
  ASSERT_GT(response.file_descriptor_response().file_descriptor_proto_size(), 0);
  ASSERT_TRUE(file.ParseFromString(response.file_descriptor_response().file_descriptor_proto(0)));
  EXPECT_EQ(file.name(), "visionserver/v1/session.proto");

  request.set_file_by_filename("etc/passwd");
  ASSERT_TRUE(stream->Write(request) && stream->Read(&response));
  EXPECT_EQ(response.error_response().error_code(), grpc::StatusCode::NOT_FOUND);
  stream->WritesDone();
  EXPECT_TRUE(stream->Finish().ok());
}

TEST(Certificate, RaisesAnAlarmWhenItsEndComesNear) {
  test::FakeClock clock;
  TestServer server({.tls = true, .clock = &clock});
  server->LookAround();
  EXPECT_TRUE(server->alarms().List().empty());
  clock.Advance(std::chrono::hours(24 * 365 * 20));  // it is made for ten years
  server->LookAround();
  ASSERT_EQ(server->alarms().List().size(), 1U);
  EXPECT_EQ(server->alarms().List()[0].id, "certificate");
}

TEST(Reflection, IsOffInTheRunTimeProfile) {
  TestServer server;
  EXPECT_EQ(test::CallRaw(server.Connect(),
                          "/grpc.reflection.v1alpha.ServerReflection/ServerReflectionInfo",
                          server.Token(Role::kAdmin))
                .status.error_code(),
            grpc::StatusCode::UNIMPLEMENTED);
}

}  // namespace
}  // namespace vs
