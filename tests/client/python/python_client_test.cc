// The Python package and its example against a whole server.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <memory>

#include "visionserver/v1/sequence.grpc.pb.h"

#include "client/call.h"
#include "client/cli/sequence_text.h"
#include "client/client.h"
#include "tests/client/fake_server.h"
#include "tests/client/simulated_sequence.h"
#include "tests/support/child_process.h"
#include "tests/support/temp_folder.h"
#include "tests/support/test_server.h"

namespace vs::test {
namespace {

class PythonClientTest : public testing::Test {
 protected:
  PythonClientTest() : server_({.tls = true}) {}

  FinishedProcess Run(const std::string& script, const std::vector<std::string>& arguments = {}) {
    const std::string key = server_.Token(Role::kRobot);
    std::vector<std::string> command = {VS_PYTHON, script};
    command.insert(command.end(), arguments.begin(), arguments.end());
    const ProcessOptions options = {
        .environment = {{"PYTHONPATH", VS_PYTHON_PACKAGES},
                        {"PYTHONDONTWRITEBYTECODE", "1"},
                        {"VISIONSERVER_TOKEN", key},
                        {"TEST_ADDRESS", server_->address()},
                        {"TEST_FINGERPRINT", server_->fingerprint()},
                        {"TEST_CA_FILE", server_.data_dir() / "tls" / "server.crt"},
                        {"TEST_API_KEY", key},
                        {"TEST_PASSWORD", TestServer::kPassword}}};
    const Result<FinishedProcess> done = RunProcess(command, options, 2 * kPatience);
    EXPECT_TRUE(done) << done.error().ToString();
    return done ? *done : FinishedProcess();
  }

  void StartSimulation() {
    const auto client = client::Client::Connect({.address = server_->address(),
                                                 .fingerprint = server_->fingerprint(),
                                                 .credential = server_.Token(Role::kEngineer)});
    ASSERT_TRUE(client) << client.error().ToString();
    const auto read = cli::SequenceFromJson(SimulatedSequence("sim"));
    ASSERT_TRUE(read) << read.error().ToString();
    client::v1::CreateSequenceRequest request;
    request.set_id("sim");
    *request.mutable_spec() = read->spec;
    const auto made = client::Call(*(*client)->connection(),
                                   &client::v1::SequenceService::Stub::CreateSequence, request);
    ASSERT_TRUE(made) << made.error().ToString();
    const auto started = (*client)->StartSequence("sim");
    ASSERT_TRUE(started) << started.error().ToString();
  }

  TestServer server_;
};

TEST_F(PythonClientTest, ConnectsLogsInAndCalls) {
  server_.AddUser("ana", Role::kViewer);
  const FinishedProcess done = Run(VS_PYTHON_TESTS "/connect_test.py");
  EXPECT_EQ(0, done.exit_code) << done.error_output;
  EXPECT_THAT(done.error_output, testing::HasSubstr("Ran 8 tests"));
}

TEST_F(PythonClientTest, ReceivesDepthInEveryCodec) {
  StartSimulation();
  const FinishedProcess done = Run(VS_PYTHON_TESTS "/depth_test.py");
  EXPECT_EQ(0, done.exit_code) << done.error_output;
  EXPECT_THAT(done.error_output, testing::HasSubstr("Ran 3 tests"));
}

// One image of 2 x 1 pixels.
v1::StreamItem SmallItem() {
  v1::StreamItem item;
  item.mutable_header()->set_kind(v1::STREAM_KIND_DISPARITY);
  item.mutable_header()->set_codec(v1::CODEC_RAW);
  item.mutable_header()->set_width(2);
  item.mutable_header()->set_height(1);
  item.set_payload("\x10\x01\x20\x01");
  return item;
}

TEST(PythonClient, GoesOnWhenItsStreamWasCutWhileItWorkedOnAnImage) {
  const TempFolder folder;
  const auto go_on = [&](int images) { std::ofstream(folder / std::to_string(images)); };
  auto server = std::make_unique<FakeServer>();
  server->streams().Publish(SmallItem());
  const auto program =
      ChildProcess::Start({VS_PYTHON, VS_PYTHON_TESTS "/reconnect_test.py"},
                          {.environment = {{"PYTHONPATH", VS_PYTHON_PACKAGES},
                                           {"PYTHONDONTWRITEBYTECODE", "1"},
                                           {"TEST_ADDRESS", server->Address()},
                                           {"TEST_FOLDER", folder.path().string()}}});
  ASSERT_TRUE(program) << program.error().ToString();
  ASSERT_TRUE((*program)->WaitForLine("image 1 is number 1")) << (*program)->ErrorOutput();
  // As the real server does with a client that took too long.
  server->streams().Cut({grpc::ABORTED, "no acknowledgement for 30 s"});
  server->streams().Publish(SmallItem());
  go_on(1);
  ASSERT_TRUE((*program)->WaitForLine("image 2 is number 2")) << (*program)->ErrorOutput();

  const int port = server->port();
  server.reset();
  server = std::make_unique<FakeServer>(nullptr, port);
  server->streams().Publish(SmallItem());
  go_on(2);
  ASSERT_TRUE((*program)->WaitForLine("image 3 is number 1")) << (*program)->ErrorOutput();

  server->streams().Cut({grpc::UNAUTHENTICATED, "log in first"}, /*stay=*/true);
  go_on(3);
  EXPECT_EQ(0, (*program)->WaitForExit()) << (*program)->ErrorOutput();
  EXPECT_THAT((*program)->ErrorOutput(), testing::HasSubstr("Ran 2 tests"));
  EXPECT_THAT((*program)->ErrorOutput(),
              testing::HasSubstr("sequence/depth: no acknowledgement for 30 s; trying again"));
}

TEST_F(PythonClientTest, HasAnExampleThatRuns) {
  StartSimulation();
  const FinishedProcess done = Run(VS_PYTHON_PACKAGES "/depth_example.py",
                                   {"--server", server_->address(), "--fingerprint",
                                    server_->fingerprint(), "--frames", "2", "sim/depth"});
  EXPECT_EQ(0, done.exit_code) << done.error_output;
  EXPECT_THAT(done.output, testing::ContainsRegex("frame [0-9]+: 130 x 97, [0-9.]+ % valid, middle "
                                                  "[0-9.]+ m, 0 dropped\n"));

  const FinishedProcess stopped = Run(
      VS_PYTHON_PACKAGES "/depth_example.py",
      {"--server", server_->address(), "--fingerprint", server_->fingerprint(), "nothing/depth"});
  EXPECT_EQ(1, stopped.exit_code);
  EXPECT_THAT(stopped.error_output, testing::StartsWith("NOT_FOUND: "));
}

}  // namespace
}  // namespace vs::test
