// What is done to greys first, against engine/stereo/condition_pair.h.
#include "gpu/kernels/condition.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <random>

#include "engine/stereo/condition_pair.h"
#include "gpu/emulation/emulated_executor.h"
#include "tests/engine/stereo/pictures.h"
#include "tests/engine/stereo/random_settings.h"
#include "tests/gpu/host_frame.h"

namespace vs::gpu {
namespace {

class ConditionStage : public testing::Test {
 protected:
  // Returns whether the greys changed.
  bool ExpectEqual(const GreyImage& left, const GreyImage& right, const SgmSettings& settings) {
    HostFrame frame(settings, left.width(), left.height());
    CopyRows(left, const_cast<uint8_t*>(frame->input[kLeft]));
    CopyRows(right, const_cast<uint8_t*>(frame->input[kRight]));
    std::memset(frame->counts, 0, sizeof *frame->counts);
    EmulatedLaunch launch(static_cast<uint32_t>(random_()));
    Condition(launch, *frame);
    const PicturePair expected = ConditionPair(left, right, settings, pool_);
    bool changed = false;
    for (const int view : {kLeft, kRight}) {
      const GreyImage& picture = view == kLeft ? expected.left : expected.right;
      const GreyImage& given = view == kLeft ? left : right;
      for (int y = 0; y < picture.height(); ++y) {
        const uint8_t* row = frame->grey[view] + static_cast<size_t>(y) * picture.width();
        EXPECT_TRUE(std::equal(row, row + picture.width(), picture.Row(y)))
            << "view " << view << ", row " << y << ", " << Describe(settings);
        changed |= !std::equal(row, row + picture.width(), given.Row(y));
      }
    }
    return changed;
  }

  GreyImage Changed(const GreyImage& picture, const std::function<int(int)>& change) {
    GreyImage out(pool_, picture.width(), picture.height());
    for (int y = 0; y < picture.height(); ++y) {
      for (int x = 0; x < picture.width(); ++x) {
        out.Row(y)[x] = static_cast<uint8_t>(std::clamp(change(picture.Row(y)[x]), 0, 255));
      }
    }
    return out;
  }

  BufferPool pool_;
  std::mt19937 random_{20261123};
};

TEST_F(ConditionStage, IsTheReferencesForRandomPictures) {
  for (int round = 0; round < 60; ++round) {
    const RandomPair pair =
        MakeRandomPair(pool_, 16 + Below(random_, 120), 16 + Below(random_, 60), random_);
    ExpectEqual(pair.left, pair.right, MakeRandomSettings(random_, 256));
    if (HasFailure()) return;
  }
}

TEST_F(ConditionStage, GivesADarkPictureTheGreysOfTheOther) {
  for (const int percent : {50, 70, 85, 99, 120}) {
    const GreyImage left = RandomGreys(130, 60, 3, pool_);
    const GreyImage right = Changed(left, [&](int grey) { return grey * percent / 100; });
    const bool changed = ExpectEqual(
        left, right, {.num_disparities = 16, .pre_blur = PreBlur::kOff, .match_gain = true});
    // 1 % may be the scene; half of the contrast is more than a camera differs by.
    EXPECT_EQ(changed, percent != 99 && percent != 50) << percent;
    ExpectEqual(left, right, {.min_disparity = 40, .num_disparities = 100});
    if (HasFailure()) return;
  }
}

TEST_F(ConditionStage, BlursWhatIsNoisy) {
  const GreyImage flat = Changed(RandomGreys(200, 120, 1, pool_), [](int) { return 120; });
  for (const int noise : {0, 1, 2, 4, 9}) {
    const auto noisy = [&](int grey) { return grey + Below(random_, 2 * noise + 1) - noise; };
    const GreyImage left = Changed(flat, noisy);
    const GreyImage right = Changed(flat, noisy);
    const bool changed = ExpectEqual(left, right, {.match_gain = false});
    EXPECT_EQ(changed, noise >= 4) << noise;
    if (HasFailure()) return;
  }
}

TEST_F(ConditionStage, LooksAtSomeBlocksOfALargePicture) {
  // 51 x 42 blocks, of which every second counts.
  const GreyImage flat = Changed(RandomGreys(410, 340, 1, pool_), [](int) { return 120; });
  const auto noisy = [&](int grey) { return grey + Below(random_, 13) - 6; };
  EXPECT_TRUE(ExpectEqual(Changed(flat, noisy), Changed(flat, noisy), {}));
}

TEST(MaskResponse, IsZeroOnSlopesAndGreatOnDots) {
  const uint8_t slope[] = {10, 20, 30, 40, 50, 60, 70, 80, 90};
  EXPECT_EQ(MaskResponse(slope + 4, 3), 0);
  const uint8_t dot[] = {0, 0, 0, 0, 9, 0, 0, 0, 0};
  EXPECT_EQ(MaskResponse(dot + 4, 3), 36);
  const uint8_t side[] = {0, 0, 0, 9, 0, 0, 0, 0, 0};
  EXPECT_EQ(MaskResponse(side + 4, 3), 18);
}

TEST_F(ConditionStage, CopesWithPicturesThatTellNothing) {
  for (const int grey : {0, 128, 255}) {
    const GreyImage flat = Changed(RandomGreys(40, 20, 1, pool_), [&](int) { return grey; });
    EXPECT_FALSE(ExpectEqual(flat, flat, {}));
    EXPECT_FALSE(ExpectEqual(flat, flat, {.pre_blur = PreBlur::kStrong}));
  }
}

}  // namespace
}  // namespace vs::gpu
