// Foreign clients must take our cameras for real ones.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/child_process.h"
#include "tests/support/gevsim.h"

namespace vs::sim {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;

class AravisTools : public testing::Test {
 protected:
  void SetUp() override {
    // A slow link and few pictures leave a busy machine the time to receive each packet.
    auto started = test::StartGevSim({"--fps", "5", "--link-mbps", "100"});
    ASSERT_TRUE(started.has_value()) << started.error().ToString();
    gevsim_ = std::move(*started);
  }
  static std::string Run(const std::vector<std::string>& command) {
    const auto done = test::RunProcess(command);
    EXPECT_TRUE(done.has_value()) << done.error().ToString();
    if (!done) return {};
    EXPECT_EQ(done->exit_code, 0) << done->error_output;
    return done->output + done->error_output;
  }

  std::unique_ptr<test::ChildProcess> gevsim_;
};

TEST_F(AravisTools, ListBothCameras) {
  const std::string list = Run({"arv-tool-0.8"});
  EXPECT_THAT(list, HasSubstr("Basler-acA1300-30gm-21000001 (127.0.0.1)"));
  EXPECT_THAT(list, HasSubstr("Basler-acA1300-30gm-21000002 (127.0.0.2)"));
}

TEST_F(AravisTools, ReadAndWriteFeatures) {
  const std::string values =
      Run({"arv-tool-0.8", "-a", "127.0.0.2", "control", "DeviceVendorName", "DeviceID", "Width",
           "ExposureTimeAbs=2500", "GainRaw=77", "GainRaw", "AcquisitionFrameRateAbs",
           "TriggerSelector=FrameStart", "TriggerMode=On", "TriggerSource", "BinningHorizontal=2",
           "BinningVertical=2", "PayloadSize", "GevTimestampTickFrequency", "GevSCPSPacketSize"});
  EXPECT_THAT(values, HasSubstr("DeviceVendorName = Basler"));
  EXPECT_THAT(values, HasSubstr("DeviceID = 21000002"));
  EXPECT_THAT(values, HasSubstr("Width = 1296 px min:1 max:1296"));
  EXPECT_THAT(values, HasSubstr("ExposureTimeAbs = 2500 us min:16 max:1e+07"));
  EXPECT_THAT(values, HasSubstr("GainRaw = 77 min:0 max:500"));
  EXPECT_THAT(values, HasSubstr("AcquisitionFrameRateAbs = 30.0003 Hz"));
  EXPECT_THAT(values, HasSubstr("TriggerMode = On"));
  EXPECT_THAT(values, HasSubstr("TriggerSource = Line1"));
  EXPECT_THAT(values, HasSubstr("PayloadSize = 312984 B"));  // 648 x 483
  EXPECT_THAT(values, HasSubstr("GevTimestampTickFrequency = 1000000000 Hz"));
}

TEST_F(AravisTools, ExplainEveryFeature) {
  const std::pair<const char*, const char*> expected[] = {
      {"ExposureTimeAbs", "Exposure time."},
      {"GevSCPD", "Pause between two stream packets"},
      {"TriggerSoftware", "Triggers the camera if it waits for a software trigger."}};
  for (const auto& [feature, tip] : expected) {
    EXPECT_THAT(Run({"arv-tool-0.8", "-a", "127.0.0.1", "description", feature}), HasSubstr(tip));
  }
}

TEST_F(AravisTools, StreamWithoutAFailure) {
  for (const char* trigger : {"", "--trigger=Line1", "--software-trigger=5"}) {
    std::vector<std::string> command = {"arv-camera-test-0.8",
                                        "--name=127.0.0.1",
                                        "--no-packet-socket",
                                        "-a",
                                        "--duration=2",
                                        "--h-binning=2",
                                        "--v-binning=2",
                                        "--frame-retention=2000",
                                        "--packet-request-ratio=2"};
    if (*trigger == '\0') {
      command.emplace_back("--frequency=5");
    } else {
      command.emplace_back(trigger);
    }
    if (std::string(trigger).find("software") != std::string::npos) {
      command.emplace_back("--trigger=Software");
    }
    const std::string report = Run(command);
    EXPECT_THAT(report, ContainsRegex("image width *= *648\n"));
    EXPECT_THAT(report, ContainsRegex("n_failures *= *0\n"));
    EXPECT_THAT(report, ContainsRegex("n_completed_buffers *= *[1-9]"));
  }
}

}  // namespace
}  // namespace vs::sim
