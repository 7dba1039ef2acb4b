// Codes and costs, against engine/stereo/cost_window.h.
#include "gpu/kernels/costs.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "engine/stereo/cost_window.h"
#include "engine/stereo/padded_picture.h"
#include "gpu/emulation/emulated_executor.h"
#include "tests/engine/stereo/pictures.h"
#include "tests/engine/stereo/random_settings.h"
#include "tests/gpu/host_frame.h"

namespace vs::gpu {
namespace {

class Costs : public testing::Test {
 protected:
  void ExpectEqual(const RandomPair& pair, const SgmSettings& settings, uint32_t seed) {
    const int width = pair.left.width();
    const int height = pair.left.height();
    HostFrame frame(settings, width, height);
    CopyRows(pair.left, frame->grey[kLeft]);
    CopyRows(pair.right, frame->grey[kRight]);
    EmulatedLaunch launch(seed);
    MakeFeatures(launch, *frame);
    MakeCosts(launch, *frame);

    PaddedPicture left;
    PaddedPicture right;
    left.Assign(pair.left, settings.sobel_cap);
    right.Assign(pair.right, settings.sobel_cap);
    CostRows rows;
    rows.Prepare(&left, &right, &pair.left, settings);
    std::vector<uint8_t> row(static_cast<size_t>(width) * settings.num_disparities);
    for (int y = 0; y < height; ++y) {
      rows.Row(y, row.data());
      for (int x = 0; x < width; ++x) {
        const uint8_t* expected = row.data() + static_cast<size_t>(x) * settings.num_disparities;
        const uint8_t* cells = frame->costs + (static_cast<size_t>(y) * width + x) * frame->pitch;
        for (int i = 0; i < frame->pitch; ++i) {
          const int cost = i < settings.num_disparities ? expected[i] : 255;
          ASSERT_EQ(cells[i], cost) << "(" << x << ", " << y << "), index " << i << " of " << width
                                    << " x " << height << " px, " << Describe(settings);
        }
      }
    }
  }

  BufferPool pool_;
  std::mt19937 random_{20261123};
};

TEST_F(Costs, AreTheReferencesForRandomSettings) {
  for (uint32_t round = 0; round < 120; ++round) {
    const RandomPair pair =
        MakeRandomPair(pool_, 16 + Below(random_, 60), 16 + Below(random_, 24), random_);
    ExpectEqual(pair, MakeRandomSettings(random_, 256), round);
    if (HasFatalFailure()) return;
  }
}

TEST_F(Costs, AreTheReferencesForEveryCostAndCensus) {
  const RandomPair pair = MakeRandomPair(pool_, 45, 37, random_);
  for (int cost = 0; cost < 4; ++cost) {
    for (int census = 0; census < 4; ++census) {
      for (const int window : {1, 4, 15}) {
        ExpectEqual(pair,
                    {.min_disparity = -3,
                     .num_disparities = 21,
                     .cost = static_cast<MatchCost>(cost),
                     .census = static_cast<CensusPattern>(census),
                     .window_width = window,
                     .window_height = window,
                     .smooth_cost = window != 4},
                    static_cast<uint32_t>(16 * cost + census));
        if (HasFatalFailure()) return;
      }
    }
  }
}

TEST_F(Costs, ReachBeyondThePicture) {
  const RandomPair pair = MakeRandomPair(pool_, 33, 16, random_);
  for (const int first : {-2048, -260, -30, 0, 32, 2048}) {
    ExpectEqual(pair, {.min_disparity = first, .num_disparities = 256}, 5);
    if (HasFatalFailure()) return;
  }
}

TEST_F(Costs, AreTheReferencesInRowsOfSeveralBlocks) {
  const RandomPair pair = MakeRandomPair(pool_, 301, 16, random_);
  for (const int range : {1, 8, 20, 129, 192, 256}) {
    for (const int first : {-40, 0, 70}) {
      ExpectEqual(pair, {.min_disparity = first, .num_disparities = range}, 6);
      if (HasFatalFailure()) return;
    }
  }
}

TEST(CostOf, ComparesFeatures) {
  const SgmSettings settings{.ad_limit = 4, .grey_limit = 63};
  const Feature l{.code = 0x0a05000f, .code_high = 3, .coarse = 10};
  const Feature r{.code = 0x11050001, .code_high = 0, .coarse = 12};
  EXPECT_EQ(CostOf<CostKind::kCensus>(l, r, settings), 3);
  EXPECT_EQ(CostOf<CostKind::kAdCensus>(l, r, settings), 3 + 4);
  EXPECT_EQ(CostOf<CostKind::kSad>(l, r, settings), 14);
  // 4 bits of the high byte differ, too, and 2 of the other half: 9, halved.
  EXPECT_EQ(CostOf<CostKind::kLongCensus>(l, r, settings), 5);
  EXPECT_EQ(CostOf<CostKind::kLongAdCensus>(l, r, settings), 5 + 2);
  // From 60 to 45..55 it is 5, from 50 to 57..61 it is 7.
  const Feature a{.code = 50 | 45 << 8 | 55 << 16, .code_high = 0, .coarse = 0};
  const Feature b{.code = 60 | 57 << 8 | 61 << 16, .code_high = 0, .coarse = 0};
  EXPECT_EQ(CostOf<CostKind::kBirchfieldTomasi>(a, b, settings), 5);
}

TEST(AverageBytes, RoundsUp) {
  EXPECT_EQ(AverageBytes(0x00ff01fe, 0x01ff02ff), 0x01ff02ffU);
  EXPECT_EQ(AverageBytes(0x00000000, 0xff030201), 0x80020101U);
}

}  // namespace
}  // namespace vs::gpu
