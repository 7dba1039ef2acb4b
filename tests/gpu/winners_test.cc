// Winners and what is made of them, against engine/stereo/selection.h.
#include "gpu/kernels/winners.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "engine/stereo/refine.h"
#include "engine/stereo/selection.h"
#include "gpu/emulation/emulated_executor.h"
#include "gpu/kernels/judge.h"
#include "tests/gpu/host_frame.h"

namespace vs::gpu {
namespace {

template <class T>
std::vector<T> PixelsOf(const Image<T>& image) {
  std::vector<T> pixels;
  for (int y = 0; y < image.height(); ++y) {
    pixels.insert(pixels.end(), image.Row(y), image.Row(y) + image.width());
  }
  return pixels;
}

template <class T>
std::vector<T> PixelsOf(const T* from, int count) {
  return {from, from + count};
}

SgmSettings RandomSettings(std::minstd_rand& random) {
  const auto below = [&](int n) { return static_cast<int>((random() >> 8) % n); };
  SgmSettings s;
  s.num_disparities = 1 + below(below(2) == 0 ? 256 : 24);
  s.min_disparity = below(2) == 0 ? 0 : below(60) - 30;
  s.directions = 1 + below(8);
  s.sub_pixel = static_cast<SubPixel>(below(3));
  s.uniqueness_percent = below(2) * below(51);
  s.min_confidence = below(2) * below(256);
  s.left_right_check = below(4) != 0;
  s.left_right_tolerance = below(9);
  s.left_right_lenient = below(2) == 0;
  return s;
}

TEST(Winners, AndTheirJudgementAreTheReferences) {
  for (uint32_t seed = 0; seed < 60; ++seed) {
    BufferPool pool;
    std::minstd_rand random(seed + 1);
    const SgmSettings settings = RandomSettings(random);
    const int width = 16 + static_cast<int>((random() >> 8) % 50);
    const int height = 16 + static_cast<int>((random() >> 8) % 5);
    HostFrame frame(settings, width, height);
    const GreyImage grey = RandomGreys(width, height, seed, pool);
    CopyRows(grey, frame->grey[kLeft]);
    // A sum that saturates sometimes, or often, with many ties or few.
    const int most = seed % 3 == 0 ? 8 : seed % 3 == 1 ? 127 : 254;
    std::vector<uint8_t> sums;
    for (int pixel = 0; pixel < frame->Pixels(); ++pixel) {
      for (int i = 0; i < settings.num_disparities; ++i) {
        int sum = 0;
        for (int k = 0; k < frame->sum_count; ++k) {
          const auto part = static_cast<uint8_t>((random() >> 8) % (most + 1));
          frame->sums[k][static_cast<size_t>(pixel) * frame->pitch + i] = part;
          sum += part;
        }
        sums.push_back(static_cast<uint8_t>(std::min(sum, 255)));
      }
    }
    DisparityMap expected = MakeDisparityMap(width, height, DisparityOffset(settings), pool);
    Selection selection;
    selection.Prepare(settings, width);
    const CellVolume volume{sums.data(), width, height, settings.num_disparities};
    for (int y = 0; y < height; ++y) selection.Row(volume, grey, y, &expected);

    EmulatedLaunch launch(seed);
    SelectWinners(launch, *frame);
    Judge(launch, *frame);
    const DeviceMap& map = frame->map[0];
    EXPECT_EQ(PixelsOf(map.disparity, frame->Pixels()), PixelsOf(expected.disparity)) << seed;
    EXPECT_EQ(PixelsOf(map.confidence, frame->Pixels()), PixelsOf(expected.confidence)) << seed;
    EXPECT_EQ(PixelsOf(map.reason, frame->Pixels()), PixelsOf(expected.reason)) << seed;
  }
}

TEST(Judge, FindsTheMinimumBetweenItsNeighbours) {
  // Two lines of slope 4 through (i - 1, 8), (i, 4) and (i + 1, 12) meet a quarter of a pixel left.
  EXPECT_EQ(SubPixelSixteenths(SubPixel::kEquiangular, {.best = 4, .before = 8, .after = 12}), -4);
  // The parabola through them: 8 * (8 - 12) / (8 + 12 - 8) = -2.67.
  EXPECT_EQ(SubPixelSixteenths(SubPixel::kParabola, {.best = 4, .before = 8, .after = 12}), -3);
  EXPECT_EQ(SubPixelSixteenths(SubPixel::kParabola, {.best = 4, .before = 4, .after = 4}), 0);
  EXPECT_EQ(SubPixelSixteenths(SubPixel::kOff, {.best = 4, .before = 8, .after = 12}), 0);
}

}  // namespace
}  // namespace vs::gpu
