// The Python package and its example against a whole server.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/child_process.h"
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

  TestServer server_;
};

TEST_F(PythonClientTest, ConnectsLogsInAndCalls) {
  server_.AddUser("ana", Role::kViewer);
  const FinishedProcess done = Run(VS_PYTHON_TESTS "/connect_test.py");
  EXPECT_EQ(0, done.exit_code) << done.error_output;
  EXPECT_THAT(done.error_output, testing::HasSubstr("Ran 8 tests"));
}

}  // namespace
}  // namespace vs::test
