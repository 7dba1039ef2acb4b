// The state of a whole server by visionctl.
#include <nlohmann/json.hpp>

#include "tests/client/cli/server_fixture.h"

namespace vs::test {
namespace {

using nlohmann::json;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;

class VisionctlStatus : public VisionctlTest {};

TEST_F(VisionctlStatus, TellsOfTheMachineAndItsGpus) {
  const std::string status = Succeed({"status"});
  EXPECT_THAT(status, HasSubstr("no alarms"));
  EXPECT_THAT(status, ContainsRegex("processor: load [0-9.]+ on [0-9]+ cores"));
  EXPECT_THAT(status, ContainsRegex("(GPU 0: .*, compute capability [0-9.]+|no GPU: .+)\n"));
  const json resources = json::parse(Succeed({"status", "--json"})).at("resources");
  EXPECT_NE(resources.at("gpus").empty(), resources.at("no_gpu_reason").get<std::string>().empty());
}

}  // namespace
}  // namespace vs::test
