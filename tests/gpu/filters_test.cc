// The filters, against engine/stereo/refine.h.
#include "gpu/kernels/filters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <random>
#include <utility>
#include <vector>

#include "engine/stereo/refine.h"
#include "engine/stereo/thread_team.h"
#include "gpu/emulation/emulated_executor.h"
#include "tests/engine/stereo/map_difference.h"
#include "tests/engine/stereo/pictures.h"
#include "tests/engine/stereo/random_settings.h"
#include "tests/gpu/host_frame.h"

namespace vs::gpu {
namespace {

// Nothing but what a test switches on.
constexpr SgmSettings kNoFilter = {
    .median = 0, .speckle_size = 0, .gated_median = false, .fill_holes = false};

class Filters : public testing::Test {
 protected:
  // A map whose disparity at (x, y) is at(x, y), with random confidences and reasons.
  DisparityMap MapOf(int width, int height, const std::function<int(int, int)>& at) {
    DisparityMap map = MakeDisparityMap(width, height, 0, pool_);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const auto stored = static_cast<uint16_t>(at(x, y));
        const bool valid = stored != kInvalidDisparity;
        map.disparity.Row(y)[x] = stored;
        map.confidence.Row(y)[x] = static_cast<uint8_t>(valid ? 1 + Below(random_, 255) : 0);
        map.reason.Row(y)[x] = static_cast<uint8_t>(valid ? 0 : 1 + Below(random_, 11));
      }
    }
    return map;
  }

  // Planes of a few levels, with single wrong pixels and holes.
  DisparityMap RandomMap(int width, int height) {
    const int block = 2 + Below(random_, 12);
    const int step = std::vector<int>{1, 15, 40, 400}[static_cast<size_t>(Below(random_, 4))];
    const int holes = Below(random_, 60);  // percent
    std::vector<int> levels(static_cast<size_t>(width / block + 1) * (height / block + 1));
    for (int& level : levels) level = 16 + step * Below(random_, 6);
    return MapOf(width, height, [&](int x, int y) {
      if (Below(random_, 100) < holes) return 0;
      if (Below(random_, 30) == 0) return Below(random_, 4096);
      return levels[static_cast<size_t>(y / block) * (width / block + 1) + x / block] +
             Below(random_, 3);
    });
  }

  void ExpectEqual(const DisparityMap& given, const GreyImage& grey, const SgmSettings& settings) {
    const int width = grey.width();
    const int height = grey.height();
    HostFrame frame(settings, width, height);
    CopyRows(grey, frame->grey[kLeft]);
    const DeviceMap& in = frame->map[0];
    DisparityMap expected = MakeDisparityMap(width, height, 0, pool_);
    for (int y = 0; y < height; ++y) {
      const size_t row = static_cast<size_t>(y) * width;
      std::copy_n(given.disparity.Row(y), width, in.disparity + row);
      std::copy_n(given.confidence.Row(y), width, in.confidence + row);
      std::copy_n(given.reason.Row(y), width, in.reason + row);
      std::copy_n(given.disparity.Row(y), width, expected.disparity.Row(y));
      std::copy_n(given.confidence.Row(y), width, expected.confidence.Row(y));
      std::copy_n(given.reason.Row(y), width, expected.reason.Row(y));
    }
    ThreadTeam team;
    Refiner().Refine(grey, settings, 1, &team, pool_, &expected);

    EmulatedLaunch launch(static_cast<uint32_t>(random_()));
    const DeviceMap out = Refine(launch, *frame);
    DisparityMap map = MakeDisparityMap(width, height, 0, pool_);
    for (int y = 0; y < height; ++y) {
      const size_t row = static_cast<size_t>(y) * width;
      std::copy_n(out.disparity + row, width, map.disparity.Row(y));
      std::copy_n(out.confidence + row, width, map.confidence.Row(y));
      std::copy_n(out.reason + row, width, map.reason.Row(y));
    }
    ASSERT_EQ(MapDifference(map, expected), "")
        << width << " x " << height << " px, " << Describe(settings);
  }

  BufferPool pool_;
  std::mt19937 random_{20261123};
};

TEST_F(Filters, AreTheReferencesForRandomMapsAndSettings) {
  for (int round = 0; round < 150; ++round) {
    const int width = 16 + Below(random_, round % 10 == 0 ? 300 : 60);
    const int height = 16 + Below(random_, 30);
    const GreyImage grey = RandomGreys(width, height, static_cast<uint32_t>(round), pool_);
    ExpectEqual(RandomMap(width, height), grey, MakeRandomSettings(random_, 16));
    if (HasFatalFailure()) return;
  }
}

TEST_F(Filters, EachByItselfIsTheReferences) {
  std::vector<SgmSettings> all(6, kNoFilter);
  all[1].median = 3;
  all[2].median = 5;
  all[3].gated_median = true;
  all[4].fill_holes = true;
  all[5].fill_background = true;
  for (const int gate : {0, 255}) {
    all.push_back(kNoFilter);
    all.back().gated_median = all.back().fill_holes = true;
    all.back().gate = gate;
  }
  const std::pair<int, int> sizes[] = {{57, 23}, {57, 23}, {16, 16}, {16, 300}, {301, 17}};
  uint32_t round = 0;
  for (const SgmSettings& settings : all) {
    for (const auto& [width, height] : sizes) {
      const GreyImage grey = RandomGreys(width, height, round++, pool_);
      ExpectEqual(RandomMap(width, height), grey, settings);
      if (HasFatalFailure()) return;
    }
  }
}

TEST_F(Filters, FillTheWidestRow) {
  SgmSettings settings = kNoFilter;
  settings.fill_background = true;
  const GreyImage grey = RandomGreys(kMaxPictureWidth, 16, 1, pool_);
  // Rows with one value, or two far from each other, or none at all.
  const auto at = [](int x, int y) {
    const bool first = y % 4 == 1 && x == 0;
    const bool last = y % 4 >= 2 && x == kMaxPictureWidth - 1 - y;
    return first ? 700 : last ? 500 : y % 4 == 3 && x == 200 ? 300 : 0;
  };
  ExpectEqual(MapOf(kMaxPictureWidth, 16, at), grey, settings);
}

TEST_F(Filters, FindRegionsOfAnyShape) {
  const int width = 150;
  const int height = 41;
  const std::vector<std::function<int(int, int)>> shapes = {
      // One region; each pixel its own; nothing.
      [](int, int) { return 100; },
      [](int x, int y) { return 100 + 1000 * ((x + y) % 2); },
      [](int, int) { return 0; },
      // A comb, joined at its top or at its bottom only.
      [](int x, int y) { return y == 0 || x % 2 == 0 ? 100 : 0; },
      [=](int x, int y) { return y == height - 1 || x % 2 == 0 ? 100 : 0; },
      // A snake: one run after the other, joined at alternating ends.
      [=](int x, int y) {
        if (y % 2 == 0) return 100;
        return x == (y % 4 == 1 ? width - 1 : 0) ? 100 : 0;
      },
      // Stairs that touch at corners only, and stairs of steps that are just small enough.
      [](int x, int y) { return (x / 3 + y) % 2 == 0 ? 100 : 0; },
      [](int x, int y) { return 100 + 16 * x + 16 * y; },
      [](int x, int y) { return 100 + 17 * x + 16 * y; },
      // Nested frames.
      [=](int x, int y) {
        const int ring = std::min({x, y, width - 1 - x, height - 1 - y});
        return ring % 2 == 0 ? 100 : 0;
      },
  };
  const GreyImage grey = RandomGreys(width, height, 1, pool_);
  for (const auto& shape : shapes) {
    for (const int size : {1, 60, 200, 3000, 65535}) {
      SgmSettings settings = kNoFilter;
      settings.speckle_size = size;
      settings.speckle_step = 1;
      ExpectEqual(MapOf(width, height, shape), grey, settings);
      if (HasFatalFailure()) return;
    }
  }
}

TEST(MedianOf, IsTheMiddleOne) {
  std::mt19937 random(5);
  for (int round = 0; round < 200; ++round) {
    uint32_t values[25];
    for (uint32_t& value : values) value = static_cast<uint32_t>(Below(random, 30));
    std::vector<uint32_t> sorted(values, values + 25);
    std::sort(sorted.begin(), sorted.end());
    ASSERT_EQ(MedianOf(values), sorted[12]);
  }
}

}  // namespace
}  // namespace vs::gpu
