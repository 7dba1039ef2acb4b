// What deploy/run.sh starts: the files in deploy/demo fit the simulated rig and the blocks.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

#include "engine/calibration/rig_file.h"
#include "engine/core/check_sequence.h"
#include "engine/sim/demo_rig.h"
#include "server/sequences/stored_sequence.h"

namespace vs {
namespace {

const std::string kDemo = VS_SOURCE_DIR "/deploy/demo/";

TEST(Demo, TheRigFileIsTheSimulatedRig) {
  const Result<StereoRig> rig = LoadRig(kDemo + "rig.json");
  ASSERT_TRUE(rig.has_value()) << rig.error().ToString();
  StereoRig simulated = sim::DemoRig();
  simulated.name = rig->name;
  EXPECT_EQ(*rig, simulated);
}

TEST(Demo, TheSequenceIsWithoutFaultAndStartsByItself) {
  std::ifstream file(kDemo + "stereo_depth.json");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const Result<StoredSequence> stored = ParseSequenceFile(text);
  ASSERT_TRUE(stored.has_value()) << stored.error().ToString();
  EXPECT_EQ(stored->spec.id, "stereo_depth");
  EXPECT_TRUE(stored->autostart);
  EXPECT_THAT(CheckSequence(stored->spec), testing::IsEmpty());
}

}  // namespace
}  // namespace vs
