// Path costs and their sums, against engine/stereo/path_cost.h.
#include "gpu/kernels/paths.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "engine/stereo/path_cost.h"
#include "gpu/emulation/emulated_executor.h"
#include "tests/gpu/host_frame.h"

namespace vs::gpu {
namespace {

struct Case {
  int width;
  int height;
  int disparities;
  int directions;
};

// min(255, sums of all directions), cell after cell without the padding.
std::vector<uint8_t> ExpectedSums(Frame& frame, const GreyImage& grey) {
  const int disparities = frame.settings.num_disparities;
  std::vector<uint8_t> costs;
  for (int pixel = 0; pixel < frame.Pixels(); ++pixel) {
    const uint8_t* cell = frame.costs + static_cast<size_t>(pixel) * frame.pitch;
    costs.insert(costs.end(), cell, cell + disparities);
  }
  std::vector<uint8_t> sums(costs.size(), 0);
  const CellVolume cost_volume{costs.data(), frame.width, frame.height, disparities};
  const CellVolume sum_volume{sums.data(), frame.width, frame.height, disparities};
  std::vector<uint8_t> scratch;
  for (int k = 0; k < frame.settings.directions; ++k) {
    AddPathCosts(kDirections[k], 0, LineCount(kDirections[k], frame.width, frame.height),
                 cost_volume, grey, MakePenalties(frame.settings), &scratch, sum_volume);
  }
  return sums;
}

std::vector<uint8_t> SumsOf(const Frame& frame) {
  std::vector<uint8_t> sums;
  for (int pixel = 0; pixel < frame.Pixels(); ++pixel) {
    for (int i = 0; i < frame.settings.num_disparities; ++i) {
      int sum = 0;
      for (int k = 0; k < frame.sum_count; ++k) {
        sum += frame.sums[k][static_cast<size_t>(pixel) * frame.pitch + i];
      }
      sums.push_back(static_cast<uint8_t>(std::min(sum, 255)));
    }
  }
  return sums;
}

template <template <int> class Path>
void Compare(const Case& c, uint32_t seed) {
  BufferPool pool;
  std::minstd_rand random(seed + 7);
  SgmSettings settings;
  settings.num_disparities = c.disparities;
  settings.directions = c.directions;
  settings.p1 = static_cast<int>(random() % 20);
  settings.p2 = settings.p1 + static_cast<int>(random() % (kMaxP2 + 1 - settings.p1));
  settings.p2_min = static_cast<int>(random() % (kMaxP2 + 1));
  settings.p2_slope_permille = static_cast<int>(random() % 200);
  HostFrame frame(settings, c.width, c.height);
  const GreyImage grey = RandomGreys(c.width, c.height, seed, pool);
  CopyRows(grey, frame->grey[kLeft]);
  const Penalties penalties = MakePenalties(settings);
  std::copy(penalties.p2.begin(), penalties.p2.end(), const_cast<uint8_t*>(frame->p2));
  for (int pixel = 0; pixel < frame->Pixels(); ++pixel) {
    uint8_t* cell = frame->costs + static_cast<size_t>(pixel) * frame->pitch;
    std::fill_n(cell, frame->pitch, uint8_t{255});
    for (int i = 0; i < c.disparities; ++i) {
      cell[i] = static_cast<uint8_t>((random() >> 8) % (kMaxCost + 1));
    }
  }
  EmulatedLaunch launch(seed);
  SumPaths<Path>(launch, *frame);
  EXPECT_EQ(SumsOf(*frame), ExpectedSums(*frame, grey))
      << c.width << " x " << c.height << ", " << c.disparities << " disparities, " << c.directions
      << " directions, seed " << seed;
}

constexpr Case kCases[] = {{16, 16, 1, 8},   {17, 19, 2, 7},   {16, 40, 7, 6},   {50, 16, 8, 5},
                           {33, 18, 64, 4},  {21, 23, 65, 8},  {18, 17, 128, 3}, {19, 20, 129, 8},
                           {40, 17, 196, 2}, {35, 16, 250, 7}, {16, 21, 256, 8}, {70, 16, 256, 1}};

TEST(Paths, AreTheReferencesForPairs) {
  uint32_t seed = 1;
  for (const Case& c : kCases) Compare<PairedPath>(c, seed++);
}

TEST(Paths, AreTheReferencesForPlainCells) {
  uint32_t seed = 100;
  for (const Case& c : kCases) Compare<PlainPath>(c, seed++);
}

}  // namespace
}  // namespace vs::gpu
