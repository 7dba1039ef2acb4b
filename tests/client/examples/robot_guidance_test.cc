// The example does what it says, with the rights of a robot.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/client/cli/server_fixture.h"

namespace vs::test {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;

class RobotGuidance : public VisionctlTest {
 protected:
  FinishedProcess Run(const std::string& fingerprint, const std::string& key) {
    const Result<FinishedProcess> done =
        RunProcess({VS_ROBOT_GUIDANCE, server_->address(), fingerprint, "sim", "depth"},
                   {.environment = {{"VISIONSERVER_TOKEN", key}}});
    EXPECT_TRUE(done) << done.error().ToString();
    return done ? *done : FinishedProcess();
  }
};

TEST_F(RobotGuidance, StartsMeasuresAndReads) {
  Succeed({"sequences", "create", "--file", "-"}, SimulatedSequence("sim"));
  const FinishedProcess done = Run(server_->fingerprint(), server_.Token(Role::kRobot));
  ASSERT_EQ(0, done.exit_code) << done.error_output;
  EXPECT_THAT(done.output, ContainsRegex("frame [0-9]+: [0-9.]+ m\n"));
  EXPECT_THAT(done.output, ContainsRegex("result [0-9]+: good\n"));
  EXPECT_THAT(Succeed({"get", "sim", "match.p2"}), ContainsRegex("match.p2 +40 "));
}

TEST_F(RobotGuidance, SaysWhatIsWrong) {
  const std::string key = server_.Token(Role::kRobot);
  EXPECT_THAT(Run(std::string(64, 'A'), key).error_output, HasSubstr("UNAVAILABLE: "));
  EXPECT_EQ(16, Run(server_->fingerprint(), "forged").exit_code);
  EXPECT_EQ(5, Run(server_->fingerprint(), key).exit_code);  // no such sequence
}

TEST(RobotGuidanceUsage, IsShownWhenSomethingIsMissing) {
  const auto done = RunProcess({VS_ROBOT_GUIDANCE, "localhost"});
  ASSERT_TRUE(done) << done.error().ToString();
  EXPECT_EQ(2, done->exit_code);
  EXPECT_THAT(done->error_output, HasSubstr("robot_guidance SERVER FINGERPRINT SEQUENCE STREAM\n"));
}

}  // namespace
}  // namespace vs::test
