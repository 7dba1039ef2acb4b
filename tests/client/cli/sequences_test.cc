// Sequences and their parameters by visionctl on a whole server.
#include <fstream>

#include <nlohmann/json.hpp>

#include "tests/client/cli/server_fixture.h"
#include "tests/support/wait_until.h"

namespace vs::test {
namespace {

using nlohmann::json;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

class VisionctlSequences : public VisionctlTest {};

TEST_F(VisionctlSequences, AreStoredShownStartedAndStopped) {
  EXPECT_THAT(Succeed({"sequences", "create", "--file", "-"}, SimulatedSequence("sim")),
              HasSubstr("sim is stored as revision 1"));
  EXPECT_THAT(Succeed({"sequences", "list"}), ContainsRegex("sim +stopped +1 .*test.engineer"));
  EXPECT_THAT(Succeed({"sequences", "validate", "sim"}), HasSubstr("sim has no faults"));

  EXPECT_THAT(Succeed({"sequences", "start", "sim"}), HasSubstr("sim: "));
  EXPECT_TRUE(WaitUntil([&] {
    const json state = json::parse(Succeed({"sequences", "state", "sim", "--json"}));
    return state.at("frames") != "0" && state.at("state") == "SEQUENCE_RUN_STATE_RUNNING";
  }));
  const std::string state = Succeed({"sequences", "state", "sim"});
  EXPECT_THAT(state, HasSubstr("sim: running, revision 1"));
  EXPECT_THAT(state, ContainsRegex("match +[0-9]+ +0 "));

  EXPECT_THAT(Fail(8, {"sequences", "delete", "sim"}), HasSubstr("visionctl: "));
  EXPECT_THAT(Succeed({"sequences", "stop", "sim"}), HasSubstr("sim: stopped"));
  EXPECT_THAT(Succeed({"sequences", "delete", "sim"}), HasSubstr("sim is deleted"));
  EXPECT_THAT(Fail(5, {"sequences", "show", "sim"}), HasSubstr("sim"));
}

TEST_F(VisionctlSequences, AreShownInTheFormInWhichTheyAreStored) {
  Succeed({"sequences", "create", "other", "--file", "-"}, SimulatedSequence("sim"));
  const std::string shown = Succeed({"sequences", "show", "other"});
  EXPECT_EQ("other", json::parse(shown).at("id"));
  EXPECT_EQ(32, json::parse(shown).at("blocks")[2].at("params").at("num_disparities"));
  EXPECT_THAT(Succeed({"sequences", "update", "other", "--file", "-", "--autostart", "on"}, shown),
              HasSubstr("other is stored as revision 2"));
  EXPECT_EQ(shown, Succeed({"sequences", "show", "other"}));
  EXPECT_THAT(Succeed({"sequences", "list"}), ContainsRegex("other .* yes"));
}

TEST_F(VisionctlSequences, TellAllTheirFaultsAtOnce) {
  const std::string faulty = R"({"id": "faulty", "blocks": [
      {"id": "a", "type": "NoSuchBlock"},
      {"id": "match", "type": "SgmStereo", "params": {"num_disparities": 100000}}]})";
  const std::string faults = Fail(6, {"sequences", "validate", "--file", "-"}, faulty);
  EXPECT_THAT(faults, HasSubstr("cannot be started"));
  EXPECT_THAT(faults, HasSubstr("\n  a: "));
  EXPECT_THAT(faults, HasSubstr("\n  match.num_disparities: "));
  EXPECT_THAT(faults, HasSubstr("\n  match.pair: "));
  EXPECT_THAT(Fail(6, {"sequences", "create", "--file", "-"}, faulty), HasSubstr("\n  a: "));

  Succeed({"sequences", "create", "--allow-faults", "--file", "-"}, faulty);
  EXPECT_THAT(Fail(6, {"sequences", "start", "faulty"}), HasSubstr("\n  a: "));
}

TEST_F(VisionctlSequences, RefuseTextThatIsNone) {
  EXPECT_THAT(Fail(6, {"sequences", "create", "--file", "-"}, "{"), HasSubstr("parse error"));
  EXPECT_THAT(Fail(5, {"sequences", "create", "--file", "/no/such/file"}),
              HasSubstr("cannot read"));
  EXPECT_THAT(Fail(6, {"sequences", "validate"}), HasSubstr("--file"));
  EXPECT_THAT(Fail(6, {"sequences", "update", "sim"}), HasSubstr("--autostart"));
}

TEST_F(VisionctlSequences, DoNotLoseTheWorkOfASecondEditor) {
  Succeed({"sequences", "create", "--file", "-"}, SimulatedSequence("sim"));
  EXPECT_THAT(Fail(8, {"sequences", "create", "--file", "-"}, SimulatedSequence("sim")),
              HasSubstr("sim"));
  const std::string etag = json::parse(Succeed({"sequences", "show", "sim", "--json"})).at("etag");
  const std::vector<std::string> update = {"sequences", "update", "sim", "--file",
                                           "-",         "--etag", etag};
  Succeed(update, SimulatedSequence("sim"));
  Succeed({"set", "sim", "match.p2", "41"});
  Fail(8, update, SimulatedSequence("sim"));
  EXPECT_THAT(Succeed({"get", "sim", "match.p2"}), ContainsRegex("match.p2 +41 "));
}

TEST_F(VisionctlSequences, AreForThoseWhoseRoleAllowsIt) {
  Succeed({"sequences", "create", "--file", "-"}, SimulatedSequence("sim"));
  Become(Role::kViewer);
  Succeed({"sequences", "show", "sim"});
  Fail(4, {"sequences", "start", "sim"});
  Fail(4, {"sequences", "delete", "sim"});
  Become(Role::kOperator);
  Succeed({"sequences", "start", "sim"});
  Succeed({"set", "sim", "match.p2", "42"});
  Fail(4, {"set", "sim", "match.directions", "3"});
  Fail(4, {"sequences", "update", "sim", "--file", "-"}, SimulatedSequence("sim"));
}

TEST_F(VisionctlSequences, TakeParametersWhileTheyRun) {
  StartSimulation();
  const std::string all = Succeed({"get", "sim"});
  EXPECT_THAT(all, ContainsRegex("match.p2 +35 +.*operator"));
  EXPECT_THAT(all, ContainsRegex("small.scale +0.2 +0.05 .. 4 +engineer"));
  EXPECT_THAT(Succeed({"get", "sim", "match"}), Not(HasSubstr("small.scale")));

  const std::string set = Succeed({"set", "sim", "match.p1", "9", "match.p2", "40"});
  EXPECT_THAT(set, HasSubstr("match.p1 = 9\nmatch.p2 = 40\n"));
  EXPECT_THAT(set, HasSubstr("in force from frame"));

  EXPECT_THAT(Fail(5, {"set", "sim", "match.p9", "1"}), HasSubstr("visionctl get sim"));
  EXPECT_THAT(Fail(5, {"get", "sim", "nothing"}), HasSubstr("visionctl get sim"));
  EXPECT_THAT(Fail(6, {"set", "sim", "match.p2", "much"}), HasSubstr("a whole number"));
  EXPECT_THAT(Fail(6, {"set", "sim", "match.p2", "-5"}), HasSubstr("match.p2"));
  EXPECT_THAT(Fail(5, {"set", "nothing", "match.p2", "5"}), HasSubstr("nothing"));
  EXPECT_THAT(Succeed({"get", "sim", "match.p2"}), ContainsRegex("match.p2 +40 "));
}

TEST_F(VisionctlSequences, HaveExamplesThatWork) {
  std::ofstream(visionctl_.home() / "stereo_depth.json") << SimulatedSequence("stereo_depth");
  visionctl_.environment()["VISIONSERVER_ADDRESS"] = server_->address();
  visionctl_.environment()["VISIONSERVER_FINGERPRINT"] = server_->fingerprint();
  int tried = 0;
  for (const char* words :
       {"sequences create", "sequences start", "sequences show", "sequences validate", "get", "set",
        "sequences update", "sequences state", "results query", "results export", "sequences stop",
        "sequences delete"}) {
    for (const std::string& example : visionctl_.Examples(words)) {
      const FinishedProcess done = visionctl_.Shell(example);
      EXPECT_EQ(0, done.exit_code) << example << ": " << done.error_output;
      ++tried;
    }
  }
  EXPECT_GE(tried, 16);
}

TEST_F(VisionctlSequences, AreMadeOfBlocksThatCanBeListed) {
  const std::string blocks = Succeed({"sequences", "blocks"});
  EXPECT_THAT(blocks, ContainsRegex("Stereo +SgmStereo +pair:"));
  EXPECT_THAT(blocks, ContainsRegex("Communicate +Publish +value:any"));
}

}  // namespace
}  // namespace vs::test
