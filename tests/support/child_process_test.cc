#include "tests/support/child_process.h"

#include <gtest/gtest.h>
#include <signal.h>

#include "engine/base/str.h"

namespace vs::test {
namespace {

using std::chrono::milliseconds;

TEST(ChildProcess, GivesExitCodeAndBothOutputs) {
  const auto done = RunProcess({"sh", "-c", "echo out; echo error >&2; exit 3"});
  ASSERT_TRUE(done.has_value()) << done.error().ToString();
  EXPECT_EQ(done->exit_code, 3);
  EXPECT_EQ(done->output, "out\n");
  EXPECT_EQ(done->error_output, "error\n");
}

TEST(ChildProcess, NamesTheProgramThatDoesNotExist) {
  const auto process = ChildProcess::Start({"/nowhere/program"});
  ASSERT_FALSE(process.has_value());
  EXPECT_EQ(process.error().code(), StatusCode::kNotFound);
  EXPECT_NE(process.error().message().find("/nowhere/program"), std::string::npos);
}

TEST(ChildProcess, PassesInputEnvironmentAndDirectory) {
  const auto done =
      RunProcess({"sh", "-c", "cat; echo $COLOUR; pwd"},
                 {.environment = {{"COLOUR", "red"}}, .input = "in ", .directory = "/"});
  ASSERT_TRUE(done.has_value()) << done.error().ToString();
  EXPECT_EQ(done->output, "in red\n/\n");
}

TEST(ChildProcess, WaitsForALineOfEitherOutput) {
  const auto process = ChildProcess::Start({"sh", "-c", "echo one; echo ready 7 >&2; sleep 1000"});
  ASSERT_TRUE(process.has_value()) << process.error().ToString();
  EXPECT_EQ((*process)->WaitForLine("ready"), "ready 7");
  EXPECT_EQ((*process)->WaitForExit(milliseconds(0)), std::nullopt);
  (*process)->Kill();
  EXPECT_EQ((*process)->WaitForExit(), 128 + SIGKILL);
}

TEST(ChildProcess, StopsWaitingForALineWhenTheProgramEnds) {
  const auto process = ChildProcess::Start({"echo", "something else"});
  ASSERT_TRUE(process.has_value()) << process.error().ToString();
  EXPECT_EQ((*process)->WaitForLine("ready"), std::nullopt);
}

TEST(ChildProcess, TakesItsOwnChildrenWithIt) {
  pid_t grandchild = 0;
  {
    const auto process = ChildProcess::Start({"sh", "-c", "sleep 1000 & echo pid $!; wait"});
    ASSERT_TRUE(process.has_value()) << process.error().ToString();
    const auto line = (*process)->WaitForLine("pid");
    ASSERT_TRUE(line.has_value());
    grandchild = std::stoi(line->substr(4));
    EXPECT_EQ(kill(grandchild, 0), 0);
  }
  // It has been killed; init, or whoever adopted it, takes its remains away.
  const std::string status = Str("/proc/", grandchild, "/stat");
  const auto gone = RunProcess(
      {"sh", "-c", Str("while grep -q -v ') Z' ", status, " 2>/dev/null; do sleep 0.01; done")});
  EXPECT_TRUE(gone.has_value()) << gone.error().ToString();
}

}  // namespace
}  // namespace vs::test
