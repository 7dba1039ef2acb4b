#include "tests/client/cli/visionctl.h"

#include <gtest/gtest.h>

#include <utility>

namespace vs::test {

Visionctl::Visionctl(std::vector<std::string> server_options)
    : server_options_(std::move(server_options)),
      environment_({{"XDG_CONFIG_HOME", home_.path()},
                    {"VISIONSERVER_ADDRESS", ""},
                    {"VISIONSERVER_CA", ""},
                    {"VISIONSERVER_FINGERPRINT", ""},
                    {"VISIONSERVER_TOKEN", ""}}) {}

std::vector<std::string> Visionctl::CommandLine(const std::vector<std::string>& arguments) const {
  std::vector<std::string> line = {VS_VISIONCTL};
  line.insert(line.end(), arguments.begin(), arguments.end());
  line.insert(line.end(), server_options_.begin(), server_options_.end());
  return line;
}

FinishedProcess Visionctl::operator()(const std::vector<std::string>& arguments,
                                      const std::string& input) const {
  Result<FinishedProcess> done =
      RunProcess(CommandLine(arguments), {.environment = environment_, .input = input});
  EXPECT_TRUE(done) << done.error().ToString();
  return done ? *done : FinishedProcess();
}

std::unique_ptr<ChildProcess> Visionctl::Start(const std::vector<std::string>& arguments) const {
  auto started = ChildProcess::Start(CommandLine(arguments), {.environment = environment_});
  EXPECT_TRUE(started) << started.error().ToString();
  return started ? std::move(*started) : nullptr;
}

}  // namespace vs::test
