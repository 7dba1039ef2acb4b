// The program visionserver itself, started as its users start it.

#include <gmock/gmock.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <fstream>
#include <map>
#include <random>

#include "visionserver/v1/camera.pb.h"
#include "visionserver/v1/result.grpc.pb.h"
#include "visionserver/v1/session.grpc.pb.h"

#include "engine/base/str.h"
#include "server/server.h"
#include "tests/support/child_process.h"
#include "tests/support/client_call.h"
#include "tests/support/raw_call.h"
#include "tests/support/raw_socket.h"
#include "tests/support/temp_folder.h"
#include "tests/support/wait_until.h"

namespace vs {
namespace {

namespace pb = visionserver::v1;
using test::CallRaw;
using test::ChildProcess;
using test::ClientCall;
using test::FinishedProcess;
using test::RawCall;
using test::RawSocket;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

constexpr const char* kInfo = "/visionserver.v1.SystemService/GetServerInfo";

class ProgramTest : public ::testing::Test {
 protected:
  void Write(const std::string& config) { std::ofstream(folder_ / "server.conf") << config; }
  std::vector<std::string> Command(const std::vector<std::string>& more = {}) {
    std::vector<std::string> command = {VS_SERVER_PROGRAM, "--config",
                                        (folder_ / "server.conf").string()};
    command.insert(command.end(), more.begin(), more.end());
    return command;
  }
  FinishedProcess RunToEnd(const std::vector<std::string>& more = {}) {
    return *test::RunProcess(Command(more));
  }
  // Up and running; its port is in port_.
  std::unique_ptr<ChildProcess> Start(const std::vector<std::string>& command) {
    auto server = *ChildProcess::Start(command);
    const auto line = server->WaitForLine("listens on");
    EXPECT_TRUE(line.has_value()) << server->ErrorOutput();
    const std::string host = "listens on 127.0.0.1:";
    const size_t at = line ? line->find(host) : std::string::npos;
    if (at != std::string::npos) {
      port_ = static_cast<uint16_t>(std::stoi(line->substr(at + host.size())));
    }
    return server;
  }
  // Of a robot, for the server that is started next.
  std::string MakeApiKey() {
    const auto server = Server::Start({.config = *ParseConfig(kPlain, "test.conf", folder_.path()),
                                       .password_cost = {.passes = 1, .memory_bytes = 8192}});
    return (*server)->access().accounts().CreateApiKey({.name = "robot"})->secret;
  }
  std::shared_ptr<grpc::Channel> Connect() const {
    return grpc::CreateChannel(Str("ipv4:127.0.0.1:", port_), grpc::InsecureChannelCredentials());
  }

  // A token of the administrator of a new server.
  std::string LogInAsAdmin(ChildProcess& server) const {
    const auto line = server.WaitForLine("one-time password");
    EXPECT_TRUE(line.has_value());
    const std::string one_time = line.value_or("").substr(line.value_or("").rfind(' ') + 1);
    const auto sessions = pb::SessionService::NewStub(Connect());
    pb::LoginRequest login;
    login.set_user("admin");
    login.set_password(one_time);
    pb::LoginResponse logged_in;
    EXPECT_TRUE(sessions->Login(ClientCall("").context(), login, &logged_in).ok());
    pb::ChangePasswordRequest change;
    change.set_old_password(one_time);
    change.set_new_password("correct horse battery");
    pb::ChangePasswordResponse changed;
    EXPECT_TRUE(
        sessions->ChangePassword(ClientCall(logged_in.token()).context(), change, &changed).ok());
    return logged_in.token();
  }

  static constexpr const char* kPlain =
      "data_dir: \"data\"\nlisten_address: \"localhost:0\"\nplaintext: true\n";
  test::TempFolder folder_;
  uint16_t port_ = 0;
};

TEST_F(ProgramTest, NamesTheLineOfABadConfiguration) {
  Write("data_dir: \"data\"\nlisten_address: \"localhost:0\"\nplane_text: true\n");
  const FinishedProcess result = RunToEnd();
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.error_output, HasSubstr("server.conf:3"));
  EXPECT_THAT(result.error_output, HasSubstr("plane_text"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "data"));
}

TEST_F(ProgramTest, SaysThatThereIsNoConfiguration) {
  EXPECT_EQ(RunToEnd().exit_code, 2);
  EXPECT_THAT(RunToEnd().error_output, HasSubstr("No such file"));
  Write("");
  EXPECT_EQ(RunToEnd().exit_code, 2);
}

TEST_F(ProgramTest, RefusesACommandLineThatMakesNoSense) {
  const FinishedProcess nothing = *test::RunProcess({VS_SERVER_PROGRAM});
  EXPECT_EQ(nothing.exit_code, 2);
  EXPECT_THAT(nothing.error_output, StartsWith("visionserver: "));
  EXPECT_THAT(nothing.error_output, HasSubstr("--config"));
  const FinishedProcess unknown = RunToEnd({"--dance"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.error_output, HasSubstr("--dance"));
  EXPECT_EQ(test::RunProcess({VS_SERVER_PROGRAM, "--help"})->exit_code, 0);
  EXPECT_EQ(test::RunProcess({VS_SERVER_PROGRAM, "--version"})->exit_code, 0);
}

TEST_F(ProgramTest, ChecksAConfigurationWithoutStarting) {
  Write(kPlain);
  const FinishedProcess result = RunToEnd({"--check-config"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.output, HasSubstr("idle_minutes: 30"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "data"));
}

TEST_F(ProgramTest, RefusesWhatItCannotListenOn) {
  Write("data_dir: \"data\"\nlisten_address: \"0.0.0.0:0\"\nplaintext: true\n");
  EXPECT_EQ(RunToEnd().exit_code, 1);
  EXPECT_THAT(RunToEnd().error_output, HasSubstr("use TLS"));
  Write("data_dir: \"data\"\nlisten_address: \"somewhere\"\n");
  EXPECT_THAT(RunToEnd().error_output, HasSubstr("not an address to listen on"));
  Write("data_dir: \"/proc/nowhere\"\nlisten_address: \"localhost:0\"\n");
  EXPECT_THAT(RunToEnd().error_output, HasSubstr("data folder"));
}

TEST_F(ProgramTest, PrintsTheFingerprintAndTheOneTimePassword) {
  Write("data_dir: \"data\"\nlisten_address: \"localhost:0\"\n");
  const auto server = Start(Command());
  const auto fingerprint = server->WaitForLine("fingerprint");
  const auto password = server->WaitForLine("one-time password");
  ASSERT_TRUE(fingerprint && password);
  EXPECT_THAT(*fingerprint, ContainsRegex(": ([0-9A-F]{2}:){31}[0-9A-F]{2}$"));
  ASSERT_THAT(*password, ContainsRegex(": ([a-z2-9]{5}-){3}[a-z2-9]{5}$"));
  // It is in no file.
  const std::string secret = password->substr(password->rfind(' ') + 1);
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_ / "data")) {
    if (!entry.is_regular_file()) continue;
    std::ifstream file(entry.path(), std::ios::binary);
    const std::string content((std::istreambuf_iterator<char>(file)), {});
    EXPECT_THAT(content, Not(HasSubstr(secret))) << entry.path();
  }
  EXPECT_THAT(server->ErrorOutput(), Not(HasSubstr(secret)));
}

TEST_F(ProgramTest, SaysWhereThePageIsUnlessThereIsNone) {
  Write(kPlain);
  {
    const auto server = Start(Command({"--web-root", folder_.path().string()}));
    EXPECT_THAT(server->WaitForLine("the page is at").value_or(""),
                ContainsRegex("the page is at http://127\\.0\\.0\\.1:[0-9]+/$"));
  }
  const auto without = Start(Command({"--no-web"}));
  without->Signal(SIGTERM);
  EXPECT_EQ(without->WaitForExit(), 0);
  EXPECT_THAT(without->Output(), Not(HasSubstr("the page")));
  EXPECT_THAT(RunToEnd({"--web-root", "/nowhere"}).error_output, HasSubstr("/nowhere"));
}

TEST_F(ProgramTest, TwoServersDoNotShareTheirData) {
  Write(kPlain);
  const auto first = Start(Command());
  const FinishedProcess second = RunToEnd();
  EXPECT_EQ(second.exit_code, 1);
  EXPECT_THAT(second.error_output, HasSubstr("in use by another server"));
  EXPECT_TRUE(CallRaw(Connect(), kInfo, "").status.ok());
}

TEST_F(ProgramTest, EndsGracefullyWhenAsked) {
  Write(kPlain);
  const auto server = Start(Command());
  const std::shared_ptr<grpc::Channel> client = Connect();
  ASSERT_TRUE(CallRaw(client, kInfo, "").status.ok());
  server->Signal(SIGTERM);
  EXPECT_EQ(server->WaitForExit(), 0);
  EXPECT_EQ(CallRaw(client, kInfo, "").status.error_code(), grpc::StatusCode::UNAVAILABLE);
  // Its data are free again.
  const auto next = Start(Command());
  EXPECT_TRUE(CallRaw(Connect(), kInfo, "").status.ok());
}

TEST_F(ProgramTest, StartsAgainAfterBeingKilled) {
  Write(kPlain);
  for (int i = 0; i < 3; ++i) {
    const auto server = Start(Command());
    EXPECT_TRUE(CallRaw(Connect(), kInfo, "").status.ok());
    server->Kill();
  }
}

// Logs a result for each pair of a simulated rig; starts by itself.
constexpr const char* kLogging = R"({"autostart": true, "revision": 1, "sequence": {"id": "log",
  "blocks": [
    {"id": "cameras", "type": "StereoCamera", "params": {
      "left": "sim:demo#left?Width=64&Height=48&AcquisitionFrameRateAbs=30",
      "right": "sim:demo#right?Width=64&Height=48&AcquisitionFrameRateAbs=30"}},
    {"id": "log", "type": "LogResult", "params": {"name_a": "skew_ms"}}],
  "connections": [{"from": "cameras.skew_ms", "to": "log.a"}]}})";

TEST_F(ProgramTest, KeepsEveryResultThatAClientSawWhenItIsKilled) {
  Write(kPlain);
  const std::string key = MakeApiKey();
  std::ofstream(folder_ / "data" / "sequences" / "log.json") << kLogging;
  std::mt19937 random(1);
  std::map<uint64_t, std::string> seen;  // results as they came, by number
  for (int round = 0; round < 5; ++round) {
    const auto server = Start(Command());
    const auto results = pb::ResultService::NewStub(Connect());
    ClientCall call(key);
    pb::WatchResultsRequest all;
    all.set_after_number(0);
    const auto watch = results->WatchResults(call.context(), all);
    pb::Result result;
    for (const auto& [number, bytes] : seen) {
      ASSERT_TRUE(watch->Read(&result)) << watch->Finish().error_message();
      ASSERT_EQ(number, result.number()) << "round " << round;
      ASSERT_EQ(bytes, result.SerializeAsString()) << "round " << round;
    }
    // The sequence runs again once there is another first frame; then the blow may fall any time.
    const auto take = [&] {
      const bool came = watch->Read(&result);
      if (came) seen[result.number()] = result.SerializeAsString();
      return came;
    };
    do {
      ASSERT_TRUE(take()) << watch->Finish().error_message() << server->ErrorOutput();
    } while (result.frame_number() != 1);
    for (auto more = random() % 40; more > 0; --more) ASSERT_TRUE(take());
    server->Kill();
    while (take()) {
    }
    EXPECT_EQ(seen.size(), seen.rbegin()->first) << "numbers are without gaps";
  }
}

TEST_F(ProgramTest, EndsInTimeWhateverIsUnderWayAndKeepsWhatItAnnounced) {
  Write(kPlain);
  std::filesystem::create_directories(folder_ / "data" / "sequences");
  std::ofstream(folder_ / "data" / "sequences" / "log.json") << kLogging;
  auto server = Start(Command());
  const std::string token = LogInAsAdmin(*server);
  const std::shared_ptr<grpc::Channel> client = Connect();
  const auto results = pb::ResultService::NewStub(client);
  ClientCall watch(token);
  pb::WatchResultsRequest from_first;
  from_first.set_after_number(0);
  const auto announced = results->WatchResults(watch.context(), from_first);
  pb::Result result;
  ASSERT_TRUE(announced->Read(&result));
  pb::DiscoverCamerasRequest search;
  search.set_timeout_ms(10'000);
  RawCall discovery(client, "/visionserver.v1.CameraService/DiscoverCameras", token);
  ASSERT_TRUE(discovery.Send(search.SerializeAsString()));
  // It is under way: what was sent after it on the same connection is answered.
  ASSERT_TRUE(CallRaw(client, kInfo, "").status.ok());

  server->Signal(SIGTERM);
  int64_t told = 1;
  while (announced->Read(&result)) ++told;
  EXPECT_EQ(announced->Finish().error_code(), grpc::StatusCode::UNAVAILABLE);
  EXPECT_EQ(discovery.Finish().error_code(), grpc::StatusCode::UNAVAILABLE);
  // The program itself ends with another code when its ten seconds are over.
  EXPECT_EQ(server->WaitForExit(), 0);

  server = Start(Command());
  pb::QueryResultsRequest count;
  count.set_sql("SELECT count(*) FROM result WHERE number <= ?1");
  count.add_arguments()->set_int_value(static_cast<int64_t>(result.number()));
  pb::QueryResultsResponse counted;
  const auto kept = pb::ResultService::NewStub(Connect());
  ASSERT_TRUE(kept->QueryResults(ClientCall(token).context(), count, &counted).ok());
  EXPECT_EQ(counted.table().rows(0).cells(0).int_value(), told);
}

TEST_F(ProgramTest, RescuesTheAdministrator) {
  Write(kPlain);
  Start(Command())->Kill();
  const auto server = Start(Command({"--rescue-admin"}));
  EXPECT_TRUE(server->WaitForLine("one-time password").has_value());
}

TEST_F(ProgramTest, RefusesAServerWithoutItsUsers) {
  Write(kPlain);
  Start(Command())->Kill();
  std::ofstream(folder_ / "data" / "users.db", std::ios::trunc) << "this is no database at all";
  std::filesystem::remove(folder_ / "data" / "users.db-wal");
  const FinishedProcess result = RunToEnd();
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.error_output, HasSubstr("users.db"));
}

TEST_F(ProgramTest, ServesOthersAfterAFloodOfIdleConnections) {
  Write(kPlain);
  std::vector<std::string> command = {"prlimit", "--nofile=100:100", "--"};
  for (const std::string& word : Command()) command.push_back(word);
  const auto server = Start(command);
  const std::shared_ptr<grpc::Channel> client = Connect();
  ASSERT_TRUE(CallRaw(client, kInfo, "").status.ok());
  {
    std::vector<RawSocket> flood;
    flood.reserve(150);
    for (int i = 0; i < 150; ++i) flood.emplace_back(port_);
    // Who was there before goes on being served.
    EXPECT_TRUE(CallRaw(client, kInfo, "").status.ok());
  }
  // And who comes afterwards.
  EXPECT_TRUE(test::WaitUntil([&] {
    grpc::ChannelArguments own_connection;
    own_connection.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
    return CallRaw(grpc::CreateCustomChannel(Str("ipv4:127.0.0.1:", port_),
                                             grpc::InsecureChannelCredentials(), own_connection),
                   kInfo, "")
        .status.ok();
  }));
}

}  // namespace
}  // namespace vs
