// deploy/run.sh as a user starts it, with programs that are built already.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <charconv>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/support/child_process.h"
#include "tests/support/temp_folder.h"
#include "tests/support/wait_until.h"

namespace vs::test {
namespace {

namespace fs = std::filesystem;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

const fs::path kPrograms = fs::path(VS_SERVER_PROGRAM).parent_path();

// The processes of a program in this test's own network, where there are no others' of its name.
std::vector<pid_t> ProcessesOf(const std::string& program) {
  std::vector<pid_t> found;
  for (const auto& entry : fs::directory_iterator("/proc")) {
    const std::string name = entry.path().filename();
    pid_t pid = 0;
    if (std::from_chars(name.data(), name.data() + name.size(), pid).ec != std::errc()) continue;
    std::error_code gone;
    if (fs::read_symlink(entry.path() / "exe", gone) == kPrograms / program && !gone &&
        fs::read_symlink(entry.path() / "ns/net", gone) == fs::read_symlink("/proc/self/ns/net")) {
      found.push_back(pid);
    }
  }
  return found;
}

class RunScript : public testing::Test {
 protected:
  std::unique_ptr<ChildProcess> Start(const std::vector<std::string>& options) {
    std::vector<std::string> command = {VS_SOURCE_DIR "/deploy/run.sh"};
    command.insert(command.end(), options.begin(), options.end());
    auto started = ChildProcess::Start(command, {.environment = {{"VISIONSERVER_BIN", kPrograms},
                                                                 {"XDG_STATE_HOME", home_.path()}},
                                                 .directory = home_.path()});
    EXPECT_TRUE(started.has_value()) << started.error().ToString();
    return started ? std::move(*started) : nullptr;
  }
  // Both programs have ended when the script has.
  static void ExpectNothingLeft() {
    EXPECT_THAT(ProcessesOf("gevsim"), IsEmpty());
    EXPECT_THAT(ProcessesOf("visionserver"), IsEmpty());
  }
  // Its complaint about a command line that makes no sense.
  std::string Refused(const std::vector<std::string>& options) {
    const auto run = Start(options);
    EXPECT_EQ(2, run->WaitForExit()) << run->Output() << run->ErrorOutput();
    EXPECT_EQ("", run->Output());
    return run->ErrorOutput();
  }

  TempFolder home_;
};

TEST_F(RunScript, StreamsForAsLongAsItIsTold) {
  const auto run = Start({"--duration", "03", "--port", "0", "--data", "odd | & \"name\""});
  EXPECT_EQ(0, run->WaitForExit()) << run->ErrorOutput();
  const std::string output = run->Output();
  EXPECT_THAT(output, ContainsRegex("streams depth from two simulated GigE cameras: [0-9.]+ fps"));
  EXPECT_THAT(output, ContainsRegex("address +127\\.0\\.0\\.1:[0-9]+\n"));
  EXPECT_THAT(output, ContainsRegex("page +https://127\\.0\\.0\\.1:[0-9]+/\n"));
  EXPECT_THAT(output, ContainsRegex("fingerprint +([0-9A-F]{2}:){31}[0-9A-F]{2}\n"));
  EXPECT_THAT(output, ContainsRegex("admin +([a-z2-9]{5}-){3}[a-z2-9]{5}\n"));
  EXPECT_THAT(output, ContainsRegex("Summary: stereo_depth: [0-9.]+ fps, [0-9]+ ms latency, "
                                    "[0-9]+ frames, [0-9]+ dropped\n"));
  EXPECT_THAT(output, HasSubstr("The server ended in order.\n"));
  EXPECT_EQ("", run->ErrorOutput());
  EXPECT_TRUE(fs::exists(home_ / "odd | & \"name\"" / "users.db"));
  ExpectNothingLeft();
}

TEST_F(RunScript, DrainsTheServerOnCtrlC) {
  const auto run = Start({"--port", "0"});
  ASSERT_TRUE(run->WaitForLine("Ctrl-C ends it")) << run->ErrorOutput();
  // As a terminal does: to everything in the foreground.
  ASSERT_EQ(0, ::kill(-run->Pid(), SIGINT));
  EXPECT_EQ(130, run->WaitForExit()) << run->ErrorOutput();
  EXPECT_THAT(run->Output(), HasSubstr("The server ended in order.\n"));
  EXPECT_EQ("", run->ErrorOutput());
  ExpectNothingLeft();
}

TEST_F(RunScript, FailsWhenTheCamerasDie) {
  const auto run = Start({"--duration", "3600", "--port", "0"});
  ASSERT_TRUE(run->WaitForLine("Try next:")) << run->ErrorOutput();
  const std::vector<pid_t> cameras = ProcessesOf("gevsim");
  ASSERT_THAT(cameras, SizeIs(1));
  ::kill(cameras.front(), SIGKILL);
  EXPECT_EQ(1, run->WaitForExit());
  EXPECT_THAT(run->ErrorOutput(), HasSubstr("run.sh: the cameras ended with code 137"));
  EXPECT_THAT(run->Output(), Not(HasSubstr("Summary")));
  ExpectNothingLeft();
}

TEST_F(RunScript, GivesUpWhenNoDepthComes) {
  fs::create_directories(home_ / "data" / "sequences");
  std::ofstream(home_ / "data" / "sequences" / "stereo_depth.json")
      << R"({"autostart": false, "sequence": {"id": "stereo_depth", "blocks": []}})";
  const auto run = Start({"--wait", "5", "--port", "0", "--data", "data"});
  EXPECT_EQ(1, run->WaitForExit());
  EXPECT_THAT(run->ErrorOutput(), HasSubstr(" within 5 s: "));
  ExpectNothingLeft();
}

TEST_F(RunScript, LeavesNothingWhenItIsKilled) {
  const auto run = Start({"--port", "0"});
  ASSERT_TRUE(run->WaitForLine("Try next:")) << run->ErrorOutput();
  run->Kill();
  EXPECT_TRUE(WaitUntil(
      [] { return ProcessesOf("gevsim").empty() && ProcessesOf("visionserver").empty(); }));
}

TEST_F(RunScript, RefusesWhatMakesNoSense) {
  EXPECT_THAT(Refused({"--fps", "0"}), HasSubstr("--fps needs a number above 0"));
  EXPECT_THAT(Refused({"--fps", "0.00"}), HasSubstr("--fps needs a number above 0"));
  EXPECT_THAT(Refused({"--duration", "soon"}), HasSubstr("--duration needs a whole number"));
  EXPECT_THAT(Refused({"--folder", "nowhere"}), HasSubstr("there is no folder nowhere"));
  EXPECT_THAT(Refused({"--port"}), HasSubstr("--port needs a value"));
  EXPECT_THAT(Refused({"--web-port", "secure"}), HasSubstr("--web-port needs a whole number"));
  EXPECT_THAT(Refused({"--colour"}), HasSubstr("unknown option --colour"));
}

}  // namespace
}  // namespace vs::test
