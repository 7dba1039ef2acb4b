#include "tests/client/cli/visionctl.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>
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

FinishedProcess Visionctl::Shell(const std::string& line) const {
  std::map<std::string, std::string> environment = environment_;
  environment["PATH"] =
      std::filesystem::path(VS_VISIONCTL).parent_path().string() + ":/usr/bin:/bin";
  Result<FinishedProcess> done =
      RunProcess({"/bin/sh", "-c", line}, {.environment = environment, .directory = home_.path()});
  EXPECT_TRUE(done) << done.error().ToString();
  return done ? *done : FinishedProcess();
}

std::vector<std::string> Visionctl::Examples(const std::string& words) const {
  std::istringstream help(Shell("visionctl " + words + " --help").output);
  std::vector<std::string> examples;
  std::string line;
  while (std::getline(help, line) && line != "Examples:") continue;
  while (std::getline(help, line) && line.starts_with("  ")) examples.push_back(line.substr(2));
  return examples;
}

std::unique_ptr<ChildProcess> Visionctl::Start(const std::vector<std::string>& arguments) const {
  auto started = ChildProcess::Start(CommandLine(arguments), {.environment = environment_});
  EXPECT_TRUE(started) << started.error().ToString();
  return started ? std::move(*started) : nullptr;
}

}  // namespace vs::test
