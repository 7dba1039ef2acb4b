// What visionctl says of a sequence when one of its two GigE Vision cameras falls silent.
#include <map>
#include <memory>

#include <nlohmann/json.hpp>

#include "tests/client/cli/server_fixture.h"
#include "tests/support/gevsim.h"
#include "tests/support/wait_until.h"

namespace vs::test {
namespace {

using nlohmann::json;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr char kPairs[] = R"({"id": "pairs",
  "blocks": [
    {"id": "cameras", "type": "StereoCamera", "params": {
       "left": "gev-ip:127.0.0.1?TriggerMode=On&TriggerSource=Line1",
       "right": "gev-ip:127.0.0.2?TriggerMode=On&TriggerSource=Line1",
       "tolerance_ms": 1000.0}},
    {"id": "publish", "type": "Publish", "params": {"stream": "pair"}}
  ],
  "connections": [{"from": "cameras.pair", "to": "publish.value"}]})";

// Stands before the server, so that it goes after it: to close a camera that is gone takes seconds.
class Cameras {
 protected:
  const TempFolder folder_;
  std::unique_ptr<ChildProcess> cameras_;
};

class VisionctlCameraFault : protected Cameras, public VisionctlTest {
 protected:
  void StartCameras(const std::vector<std::string>& options) {
    auto started = StartGevSim(options);
    ASSERT_TRUE(started.has_value()) << started.error().ToString();
    cameras_ = std::move(*started);
    Succeed({"sequences", "create", "--file", "-"}, kPairs);
    Succeed({"sequences", "start", "pairs"});
  }
  json State() { return json::parse(Succeed({"sequences", "state", "pairs", "--json"})); }
  // What the block "cameras" says of its pictures.
  static std::map<std::string, json> Readings(const json& state) {
    std::map<std::string, json> readings;
    for (const json& one : state.at("blocks").at(0).at("readings")) {
      readings[one.at("name")] = one.at("value");
    }
    return readings;
  }
  // A count, which JSON carries as text.
  static int64_t Count(const json& state, const std::string& name) {
    return std::stoll(Readings(state).at(name).at("int_value").get<std::string>());
  }
};

TEST_F(VisionctlCameraFault, IsNamedWhenACameraIsMissingFromTheStart) {
  StartCameras({"--fps", "20", "--only", "left"});
  json state;
  ASSERT_TRUE(WaitUntil([&] {
    state = State();
    return state.at("state") == "SEQUENCE_RUN_STATE_DEGRADED" && Count(state, "left_overflow") > 0;
  })) << state.dump();
  EXPECT_EQ("0", state.at("frames"));
  EXPECT_EQ("pairs/cameras", state.at("last_error").at("path"));
  EXPECT_THAT(state.at("last_error").at("message").get<std::string>(),
              StartsWith("right camera: "));
  EXPECT_EQ(0, Count(state, "pairs"));
  EXPECT_EQ(0, Count(state, "right_overflow"));

  const std::string text = Succeed({"sequences", "state", "pairs"});
  EXPECT_THAT(text, HasSubstr("pairs: degraded"));
  EXPECT_THAT(text, ContainsRegex("cameras +left_overflow +[1-9]"));
  EXPECT_THAT(text, ContainsRegex("last error, since .*: pairs/cameras: right camera: "));
}

TEST_F(VisionctlCameraFault, IsNamedWhileItLastsAndPairsGoOnAfterwards) {
  const std::string control = (folder_ / "control").string();
  StartCameras({"--fps", "20", "--control", control});
  json state;
  ASSERT_TRUE(WaitUntil([&] {
    state = State();
    return state.at("state") == "SEQUENCE_RUN_STATE_RUNNING" && Count(state, "pairs") > 5;
  })) << state.dump();
  EXPECT_FALSE(Readings(state).at("by_trigger").at("bool_value").get<bool>());
  // 20 pictures a second: just under half of 50 ms, however much more was asked for.
  EXPECT_LT(Readings(state).at("tolerance_ms").at("double_value").get<double>(), 25);

  ASSERT_TRUE(AskGevSim(control, "right drop 1").has_value());
  ASSERT_TRUE(WaitUntil([&] {
    state = State();
    return state.at("state") == "SEQUENCE_RUN_STATE_DEGRADED" && Count(state, "left_overflow") > 0;
  })) << state.dump();
  EXPECT_THAT(state.at("last_error").at("message").get<std::string>(),
              StartsWith("right camera: "));

  ASSERT_TRUE(AskGevSim(control, "right clear").has_value());
  const int64_t pairs = Count(state, "pairs");
  EXPECT_TRUE(WaitUntil([&] {
    state = State();
    return state.at("state") == "SEQUENCE_RUN_STATE_RUNNING" && Count(state, "pairs") > pairs + 5;
  })) << state.dump();
}

}  // namespace
}  // namespace vs::test
