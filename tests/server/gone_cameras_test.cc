// The program visionserver ends in time when the cameras of its running sequence are gone.

#include <gtest/gtest.h>
#include <signal.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include "tests/support/child_process.h"
#include "tests/support/gevsim.h"
#include "tests/support/temp_folder.h"

namespace vs {
namespace {

using test::ChildProcess;

// Both cameras and the sequence of the demo.
class GoneCameras : public ::testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    auto cameras = test::StartGevSim({"--fps", "5"});
    ASSERT_TRUE(cameras.has_value()) << cameras.error().ToString();
    cameras_ = std::move(*cameras);
    const std::filesystem::path demo = VS_DEMO_DIR;
    const std::filesystem::path data = folder_ / "data";
    std::filesystem::create_directories(data / "rigs");
    std::filesystem::create_directories(data / "sequences");
    std::filesystem::copy_file(demo / "rig.json", data / "rigs" / "demo.json");
    std::filesystem::copy_file(demo / "stereo_depth.json", data / "sequences/stereo_depth.json");
    const std::string config = (folder_ / "server.conf").string();
    std::ofstream(config)
        << "data_dir: \"data\"\nlisten_address: \"localhost:0\"\nplaintext: true\n";
    server_ = *ChildProcess::Start({VS_SERVER_PROGRAM, "--config", config, "--report", "1"});
    ASSERT_TRUE(server_->WaitForLine("stereo_depth: ")) << server_->ErrorOutput();
  }

  // The program ends with another code when its ten seconds are over.
  void ExpectDrainedEnd() {
    server_->Signal(SIGTERM);
    EXPECT_EQ(server_->WaitForExit(), 0) << server_->ErrorOutput();
  }

  const test::TempFolder folder_;
  std::unique_ptr<ChildProcess> cameras_;
  std::unique_ptr<ChildProcess> server_;
};

// Killed, or hanging.
INSTANTIATE_TEST_SUITE_P(By, GoneCameras, ::testing::Values(SIGKILL, SIGSTOP),
                         [](const auto& by) { return by.param == SIGKILL ? "Kill" : "Stop"; });

TEST_P(GoneCameras, AtTheMomentOfTheEnd) {
  cameras_->Signal(GetParam());
  ExpectDrainedEnd();
}

TEST_P(GoneCameras, WhenTheyAreMissed) {
  cameras_->Signal(GetParam());
  ASSERT_TRUE(server_->WaitForLine(" stalled: ")) << server_->ErrorOutput();
  ExpectDrainedEnd();
}

TEST_P(GoneCameras, WhenTheyAreLost) {
  cameras_->Signal(GetParam());
  ASSERT_TRUE(server_->WaitForLine("does not answer any more")) << server_->ErrorOutput();
  ExpectDrainedEnd();
}

}  // namespace
}  // namespace vs
