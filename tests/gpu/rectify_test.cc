// Rectified pictures, against engine/image/rectification.h.
#include "gpu/kernels/rectify.h"

#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <vector>

#include "gpu/emulation/emulated_executor.h"
#include "tests/engine/stereo/random_rectification.h"
#include "tests/gpu/host_frame.h"

namespace vs::gpu {
namespace {

std::vector<uint8_t> PixelsOf(const GreyImage& image) {
  std::vector<uint8_t> pixels;
  for (int y = 0; y < image.height(); ++y) {
    pixels.insert(pixels.end(), image.Row(y), image.Row(y) + image.width());
  }
  return pixels;
}

void Compare(const RectificationKind& kind, uint32_t seed) {
  BufferPool pool;
  std::mt19937 random(seed);
  const int raw_width = 32 + Below(random, 60);
  const int raw_height = 32 + Below(random, 30);
  const GreyImage left = RandomGreys(raw_width, raw_height, seed, pool);
  const GreyImage right = RandomGreys(raw_width, raw_height, seed + 1, pool);
  const StereoPlan plan{.rectification = MakeRandomRectification(
                            left, 16 + Below(random, 150), 16 + Below(random, 30), random, kind),
                        .settings = {.num_disparities = 8}};
  HostFrame frame(plan, raw_width, raw_height);
  CopyRows(left, frame->uploaded[kLeft]);
  CopyRows(right, frame->uploaded[kRight]);
  EmulatedLaunch launch(seed);
  Rectify(launch, *frame);
  const Rectification& how = *plan.rectification;
  const auto got = [&](int view) {
    return std::vector<uint8_t>(frame->input[view], frame->input[view] + frame->Pixels());
  };
  EXPECT_EQ(got(kLeft), PixelsOf(Rectified(left, how, how.left, pool))) << "seed " << seed;
  EXPECT_EQ(got(kRight), PixelsOf(Rectified(right, how, how.right, pool))) << "seed " << seed;
}

TEST(Rectify, GivesTheHostsPicturesForEveryKindOfTable) {
  uint32_t seed = 1;
  for (const auto interpolation :
       {Interpolation::kNearest, Interpolation::kLinear, Interpolation::kCubic}) {
    for (const bool exact : {false, true}) {
      for (const bool half_size : {false, true}) {
        for (const int wild_px : {0, 2, 40}) {
          Compare({interpolation, exact, half_size, wild_px}, seed++);
        }
      }
    }
  }
}

TEST(Rectify, LeavesARectifiedPairWhereItIs) {
  HostFrame frame(SgmSettings{.num_disparities = 8}, 20, 16);
  EXPECT_FALSE(frame->Rectifies());
  EXPECT_EQ(frame->input[kLeft], frame->uploaded[kLeft]);
  EXPECT_EQ(frame->input[kRight], frame->uploaded[kRight]);
}

}  // namespace
}  // namespace vs::gpu
