#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/client/cli/visionctl.h"
#include "tests/client/simulated_sequence.h"
#include "tests/support/test_server.h"

namespace vs::test {

// A whole server, and visionctl logged in to it by the token of a role.
class VisionctlTest : public testing::Test {
 protected:
  explicit VisionctlTest(const std::string& config = "")
      : server_({.tls = true, .config = config}), visionctl_(Options()) {
    Become(Role::kEngineer);
  }

  std::vector<std::string> Options() {
    return {"--server", server_->address(), "--fingerprint", server_->fingerprint()};
  }
  void Become(Role role) { visionctl_.environment()["VISIONSERVER_TOKEN"] = server_.Token(role); }

  // The output of a command that must succeed.
  std::string Succeed(const std::vector<std::string>& arguments, const std::string& input = "") {
    const FinishedProcess done = visionctl_(arguments, input);
    EXPECT_EQ(0, done.exit_code) << testing::PrintToString(arguments) << done.error_output;
    return done.output;
  }
  // The error of a command that must end with this code, having printed nothing else.
  std::string Fail(int exit_code, const std::vector<std::string>& arguments,
                   const std::string& input = "") {
    const FinishedProcess done = visionctl_(arguments, input);
    EXPECT_EQ(exit_code, done.exit_code) << testing::PrintToString(arguments) << done.error_output;
    EXPECT_EQ("", done.output);
    return done.error_output;
  }
  // The simulated sequence "sim", running.
  void StartSimulation() {
    Succeed({"sequences", "create", "--file", "-"}, SimulatedSequence("sim"));
    Succeed({"sequences", "start", "sim"});
  }

  TestServer server_;
  Visionctl visionctl_;
};

}  // namespace vs::test
