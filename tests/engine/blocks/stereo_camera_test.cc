#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>

#include "engine/camera/camera_hub.h"
#include "tests/engine/camera/scripted_camera.h"
#include "tests/support/block_harness.h"

namespace vs::test {
namespace {

using ::testing::HasSubstr;

constexpr int64_t kPeriodNs = 33'333'333;

std::map<std::string, ScriptedCamera*> cameras;

VS_REGISTER_CAMERA("script", [](const CameraUri& uri) -> Result<std::unique_ptr<CameraSource>> {
  auto camera = std::make_unique<ScriptedCamera>(uri);
  cameras[uri.address] = camera.get();
  return std::unique_ptr<CameraSource>(std::move(camera));
});

class StereoCameraBlock : public testing::Test {
 protected:
  StereoCameraBlock() {
    block_.environment.cameras = &hub_;
    EXPECT_TRUE(block_.Set("left", std::string("script:left")).ok());
    EXPECT_TRUE(block_.Set("right", std::string("script:right")).ok());
  }

  void Deliver(uint64_t number, int64_t skew_ns = 0) {
    const int64_t instant_ns = static_cast<int64_t>(number) * kPeriodNs;
    cameras["left"]->Deliver(number, instant_ns);
    cameras["right"]->Deliver(number, instant_ns + skew_ns);
  }

  CameraHub hub_;
  BlockHarness block_{"StereoCamera"};
};

TEST_F(StereoCameraBlock, GivesThePairWithItsTimesAndSkew) {
  ASSERT_TRUE(block_.Start().ok());
  EXPECT_FALSE(block_.block().Ready());
  Deliver(3, 2'000'000);
  ASSERT_TRUE(block_.block().Ready());
  ASSERT_TRUE(block_.Run().ok());
  const auto* pair = block_.Output<StereoFrame>("pair");
  ASSERT_NE(pair, nullptr);
  EXPECT_EQ(pair->left->number, 3u);
  EXPECT_EQ(*block_.Output<double>("skew_ms"), 2.0);
  EXPECT_EQ(block_.frame.source_number, 3u);
  EXPECT_EQ(block_.frame.capture_ns, 3 * kPeriodNs);
}

TEST_F(StereoCameraBlock, ReadsNoPicturesOutsideTheAllowedFolders) {
  CameraHub hub({.data_dir = "/var/lib/vs", .picture_roots = {"/srv/pictures"}});
  block_.environment.cameras = &hub;
  ASSERT_TRUE(block_.Set("right", std::string("file:/etc")).ok());
  EXPECT_THAT(block_.Start().ToString(), HasSubstr("right: \"/etc\" is outside the folders"));
}

TEST_F(StereoCameraBlock, KeepsTheNewestPairAndCountsTheOthers) {
  ASSERT_TRUE(block_.Start().ok());
  for (uint64_t i = 1; i <= 5; ++i) Deliver(i);
  ASSERT_TRUE(block_.Run().ok());
  EXPECT_EQ(block_.Output<StereoFrame>("pair")->number, 5u);
  EXPECT_EQ(block_.block().Dropped(), 4u);
}

TEST_F(StereoCameraBlock, PairsWithinTheGivenToleranceOnly) {
  ASSERT_TRUE(block_.Set("tolerance_ms", 1.0).ok());
  ASSERT_TRUE(block_.Start().ok());
  Deliver(1, 1'500'000);
  EXPECT_FALSE(block_.block().Ready());
  Deliver(2, 500'000);
  EXPECT_TRUE(block_.block().Ready());
}

TEST_F(StereoCameraBlock, WakesTheSequenceForEachPair) {
  std::atomic<int> woken = 0;
  block_.block().Attach(&block_.environment, block_.frame.run, [&woken] { ++woken; });
  ASSERT_TRUE(block_.block().Start().ok());
  Deliver(1);
  Deliver(2);
  EXPECT_EQ(woken, 2);
}

TEST_F(StereoCameraBlock, ReportsItsPairingWhileItRuns) {
  EXPECT_TRUE(block_.block().Report().readings.empty());
  ASSERT_TRUE(block_.Start().ok());
  for (int i = 1; i <= 16; ++i) cameras["left"]->Deliver(i, i * kPeriodNs);
  const SourceReport report = block_.block().Report();
  EXPECT_THAT(report.problem, HasSubstr("right camera: no pictures come"));
  EXPECT_THAT(report.readings, testing::Contains(Reading{"left_overflow", int64_t{12}}));
  block_.block().Stop();
  EXPECT_TRUE(block_.block().Report().readings.empty());
}

TEST_F(StereoCameraBlock, LetsGoOfItsCamerasWhenItStops) {
  ASSERT_TRUE(block_.Start().ok());
  EXPECT_EQ(hub_.List().size(), 2u);
  block_.block().Stop();
  EXPECT_TRUE(hub_.List().empty());
}

TEST_F(StereoCameraBlock, NamesTheSideThatIsWrong) {
  ASSERT_TRUE(block_.Set("right", std::string("script:broken")).ok());
  EXPECT_THAT(block_.Start().message(), HasSubstr("right camera"));
  ASSERT_TRUE(block_.Set("right", std::string("")).ok());
  EXPECT_THAT(block_.Start().message(), HasSubstr("set right to a camera's address"));
  ASSERT_TRUE(block_.Set("right", std::string("right")).ok());
  EXPECT_THAT(block_.Start().message(), HasSubstr("right: camera \"right\""));
}

}  // namespace
}  // namespace vs::test
