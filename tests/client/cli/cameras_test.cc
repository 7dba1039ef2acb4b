// Cameras and their features by visionctl on a whole server with simulated cameras.
#include <nlohmann/json.hpp>

#include "tests/client/cli/server_fixture.h"

namespace vs::test {
namespace {

using nlohmann::json;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;

class VisionctlCameras : public VisionctlTest {
 protected:
  VisionctlCameras()
      : VisionctlTest(
            "camera { id: \"left\" uri: \"sim:demo#left\" }\n"
            "camera { id: \"right\" uri: \"sim:demo#right\" }\n") {}
};

TEST_F(VisionctlCameras, AreListed) {
  const std::string list = Succeed({"cameras", "list"});
  EXPECT_THAT(list, ContainsRegex("left .* sim:demo#left"));
  EXPECT_THAT(list, ContainsRegex("right .* sim:demo#right"));
  EXPECT_EQ(2U, json::parse(Succeed({"cameras", "list", "--json"})).at("cameras").size());
}

TEST_F(VisionctlCameras, ShowAndTakeFeatures) {
  EXPECT_THAT(Succeed({"cameras", "features", "left"}), ContainsRegex("ExposureTime.* yes "));
  EXPECT_THAT(Succeed({"cameras", "set", "left", "ExposureTimeAbs", "5000"}),
              ContainsRegex("ExposureTimeAbs +5000"));
  EXPECT_THAT(Succeed({"cameras", "get", "left", "ExposureTimeAbs", "Width"}),
              ContainsRegex("ExposureTimeAbs +[0-9]+\nWidth +[0-9]+\n"));
}

TEST_F(VisionctlCameras, SayWhatTheyDoNotHaveOrTake) {
  Fail(5, {"cameras", "features", "middle"});
  EXPECT_THAT(Fail(5, {"cameras", "set", "left", "Zoom", "2"}),
              HasSubstr("visionctl cameras features left"));
  Fail(5, {"cameras", "get", "left", "Zoom"});
  EXPECT_THAT(Fail(6, {"cameras", "set", "left", "ExposureTimeAbs", "long"}),
              HasSubstr("a number"));
  Fail(6, {"cameras", "set", "left", "ExposureTimeAbs", "-1"});
  Become(Role::kViewer);
  Fail(4, {"cameras", "set", "left", "ExposureTimeAbs", "5000"});
}

}  // namespace
}  // namespace vs::test
