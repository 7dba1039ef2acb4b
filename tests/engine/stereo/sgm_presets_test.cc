#include "engine/stereo/sgm_presets.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vs {
namespace {

using testing::HasSubstr;

TEST(SgmPresets, AreValidAndDiffer) {
  const auto names = SgmPresetNames();
  for (size_t a = 0; a < names.size(); ++a) {
    const auto settings = ApplySgmPreset(names[a]);
    ASSERT_TRUE(settings.has_value()) << names[a];
    EXPECT_TRUE(ValidateSettings(*settings).ok()) << ValidateSettings(*settings).ToString();
    for (size_t b = 0; b < a; ++b) {
      EXPECT_FALSE(*settings == *ApplySgmPreset(names[b])) << names[a] << " is " << names[b];
    }
  }
}

TEST(SgmPresets, LeaveTheRangeAlone) {
  const auto strict = ApplySgmPreset("strict", {.min_disparity = -3, .num_disparities = 77});
  ASSERT_TRUE(strict.has_value());
  EXPECT_EQ(-3, strict->min_disparity);
  EXPECT_EQ(77, strict->num_disparities);
}

TEST(SgmPresets, StrictFillsNothing) {
  const SgmSettings strict = ApplySgmPreset("strict").value();
  EXPECT_FALSE(strict.fill_holes || strict.fill_background || strict.left_right_lenient);
}

TEST(SgmPresets, AnUnknownOneIsToldWithThoseThatThereAre) {
  const auto none = ApplySgmPreset("best");
  ASSERT_FALSE(none.has_value());
  EXPECT_THAT(none.error().message(), HasSubstr("\"best\"; choose quality, strict"));
}

}  // namespace
}  // namespace vs
