// What README.md promises: its commands work on the demo as they stand there, and the block that it
// shows is the one in the tree.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/server/vision/demo.h"
#include "tests/support/child_process.h"
#include "tests/support/gevsim.h"
#include "tests/support/temp_folder.h"
#include "tests/support/test_server.h"

namespace vs::test {
namespace {

const std::filesystem::path kRoot = VS_SOURCE_DIR;

std::string TextOf(const std::filesystem::path& path) {
  std::ifstream file(path);
  EXPECT_TRUE(file.good()) << path;
  return {std::istreambuf_iterator<char>(file), {}};
}

// The indented lines that call visionctl.
std::vector<std::string> Commands() {
  std::vector<std::string> commands;
  std::ifstream file(kRoot / "README.md");
  for (std::string line; std::getline(file, line);) {
    const size_t begin = line.find("    visionctl ");
    if (begin != std::string::npos) commands.push_back(line.substr(begin));
  }
  return commands;
}

TEST(Readme, ShowsABlockAsItIs) {
  const std::string block = TextOf(kRoot / "engine/blocks/stereo/speckle_filter.cc");
  EXPECT_THAT(TextOf(kRoot / "README.md"), testing::HasSubstr("```cpp\n" + block + "```\n"));
}

TEST(Readme, HasCommandsThatWork) {
  const auto cameras = StartGevSim({"--fps", "5"});
  ASSERT_TRUE(cameras.has_value()) << cameras.error().ToString();
  TestServer server({.tls = true});
  const Status demo = RestartAsDemo(&server);
  ASSERT_TRUE(demo.ok()) << demo.ToString();
  const TempFolder home;
  const ProcessOptions options = {
      .environment = {{"HOME", home.path()},
                      {"PATH", std::filesystem::path(VS_VISIONCTL).parent_path().string() +
                                   ":/usr/bin:/bin"},
                      {"VISIONSERVER_ADDRESS", server->address()},
                      {"VISIONSERVER_FINGERPRINT", server->fingerprint()},
                      {"VISIONSERVER_TOKEN", server.Token(Role::kEngineer)}},
      .directory = home.path()};
  int tried = 0;
  for (std::string command : Commands()) {
    if (command.find(" login ") != std::string::npos) continue;               // asks for a password
    if (command.find(" tail") != std::string::npos) command += " --lines 1";  // or never ends
    const auto done = RunProcess({"/bin/sh", "-c", command}, options);
    ASSERT_TRUE(done.has_value()) << command << ": " << done.error().ToString();
    EXPECT_EQ(0, done->exit_code) << command << ": " << done->error_output;
    EXPECT_NE("", done->output) << command;
    ++tried;
  }
  EXPECT_GE(tried, 6);
}

}  // namespace
}  // namespace vs::test
