#include "engine/calibration/validate_rig.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "tests/engine/calibration/sample_rig.h"

namespace vs {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<std::string> WrongFields(const StereoRig& rig) {
  std::vector<std::string> subjects;
  const Status status = ValidateRig(rig);
  for (const Fault& fault : status.faults()) subjects.push_back(fault.subject);
  return subjects;
}

TEST(ValidateRig, AcceptsARealRig) { EXPECT_THAT(WrongFields(SampleRig()), IsEmpty()); }

TEST(ValidateRig, NamesEveryWrongFieldOfACamera) {
  StereoRig rig = SampleRig();
  rig.left.width = 15;
  rig.left.height = 20000;
  rig.left.fx_px = 0;
  rig.left.fy_px = -1;
  rig.right.cx_px = 1296;
  rig.right.cy_px = -0.5;
  rig.right.k1 = std::numeric_limits<double>::quiet_NaN();
  rig.right.p2 = std::numeric_limits<double>::infinity();
  EXPECT_THAT(WrongFields(rig), ElementsAre("left.width", "left.height", "left.fx_px", "left.fy_px",
                                            "right.cx_px", "right.cy_px", "right.k1", "right.p2"));
  EXPECT_EQ(ValidateRig(rig).message(), "stereo rig \"sample\": 8 fields are wrong");
}

TEST(ValidateRig, WantsAProperRotation) {
  StereoRig rig = SampleRig();
  rig.right_from_left_rotation = {1, 0, 0, 0, 1, 1e-5, 0, 0, 1};
  EXPECT_THAT(WrongFields(rig), ElementsAre("right_from_left.rotation"));
  rig.right_from_left_rotation = {1, 0, 0, 0, 1, 0, 0, 0, -1};
  EXPECT_THAT(ValidateRig(rig).ToString(), HasSubstr("is a reflection"));
  rig.right_from_left_rotation = {1, 0, 0, 0, 1, 0, 0, 0, std::nan("")};
  EXPECT_THAT(WrongFields(rig), testing::Contains("right_from_left.rotation"));
}

TEST(ValidateRig, WantsTheRightCameraOnTheRight) {
  StereoRig rig = SampleRig();
  rig.right_from_left_translation_m = {0.12, 0, 0};
  EXPECT_THAT(ValidateRig(rig).ToString(), HasSubstr("exchange the cameras"));
  rig.right_from_left_translation_m = {-0.1, 0.2, 0};
  EXPECT_THAT(ValidateRig(rig).ToString(), HasSubstr("mostly to its right"));
  rig.right_from_left_translation_m = {-120, 0, 0};
  EXPECT_THAT(ValidateRig(rig).ToString(), HasSubstr("is the unit metres?"));
  rig.right_from_left_translation_m = {0, 0, 0};
  EXPECT_THAT(WrongFields(rig), ElementsAre("right_from_left.translation_m"));
  rig.right_from_left_translation_m = {std::nan(""), 0, 0};
  EXPECT_THAT(WrongFields(rig), ElementsAre("right_from_left.translation_m"));
}

}  // namespace
}  // namespace vs
