// Depth, against engine/stereo/depth.h, and how it comes down with the rest.
#include "gpu/kernels/depth.h"

#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "engine/stereo/refine.h"
#include "engine/stereo/selection.h"
#include "gpu/download.h"
#include "gpu/emulation/emulated_executor.h"
#include "tests/engine/stereo/map_difference.h"
#include "tests/engine/stereo/random_rectification.h"
#include "tests/gpu/host_frame.h"

namespace vs::gpu {
namespace {

class DepthOnDevice : public testing::Test {
 protected:
  // Each third disparity is invalid, some lie beyond infinity.
  DisparityMap RandomMap(int width, int height, int offset_px) {
    DisparityMap map = MakeDisparityMap(width, height, offset_px, pool_);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        map.disparity.Row(y)[x] =
            Below(random_, 3) == 0 ? uint16_t{0} : static_cast<uint16_t>(Below(random_, 6000));
        map.confidence.Row(y)[x] = static_cast<uint8_t>(Below(random_, 256));
        map.reason.Row(y)[x] = static_cast<uint8_t>(Below(random_, 12));
      }
    }
    return map;
  }
  // The stages' last step and the way down, when `which` of both maps came out of the others.
  StereoResult Finish(const StereoPlan& plan, HostFrame& frame, int which, const DisparityMap& map,
                      const GreyImage& left) {
    const DeviceMap& on_device = frame->map[which];
    const auto row = static_cast<size_t>(frame->width);
    for (int y = 0; y < frame->height; ++y) {
      const size_t at = row * static_cast<size_t>(y);
      std::memcpy(on_device.disparity + at, map.disparity.Row(y), 2 * row);
      std::memcpy(on_device.confidence + at, map.confidence.Row(y), row);
      std::memcpy(on_device.reason + at, map.reason.Row(y), row);
    }
    EmulatedLaunch launch(1);
    MakeDepth(launch, *frame, on_device);
    const Download download = DownloadOf(*frame, on_device);
    const Buffer bytes = pool_.Acquire(download.size_bytes);
    std::memcpy(bytes.data, download.begin, download.size_bytes);
    return ResultIn(bytes, plan, *frame, on_device, left);
  }

  BufferPool pool_;
  std::mt19937 random_{20261123};
};

TEST_F(DepthOnDevice, IsTheHostsAndComesDownWithTheMapAndTheRectifiedPicture) {
  const GreyImage raw = RandomGreys(61, 40, 5, pool_);
  for (const int which : {0, 1}) {
    for (const int min_disparity : {0, -30}) {
      const StereoPlan plan{.rectification = MakeRandomRectification(raw, 51, 33, random_),
                            .settings = {.min_disparity = min_disparity, .num_disparities = 8},
                            .depth = true};
      HostFrame frame(plan, 61, 40);
      CopyRows(RandomGreys(51, 33, 6, pool_), frame->input[kLeft]);
      DisparityMap map = RandomMap(51, 33, DisparityOffset(plan.settings));
      map.geometry = plan.rectification->geometry;
      const StereoResult result = Finish(plan, frame, which, map, raw);
      EXPECT_EQ(MapDifference(result.disparity, map), "");
      EXPECT_EQ(result.disparity.geometry, map.geometry);
      EXPECT_EQ(DepthDifference(result.depth, *DepthFromDisparity(map, pool_)), "");
      EXPECT_EQ(RowsOf(result.left), RowsOf(RandomGreys(51, 33, 6, pool_)));
    }
  }
}

TEST_F(DepthOnDevice, IsLeftOutWhenNobodyWantsIt) {
  const GreyImage left = RandomGreys(20, 16, 5, pool_);
  const StereoPlan plan{.settings = {.num_disparities = 8}};
  for (const int which : {0, 1}) {
    HostFrame frame(plan, 20, 16);
    const DisparityMap map = RandomMap(20, 16, 0);
    const StereoResult result = Finish(plan, frame, which, map, left);
    EXPECT_EQ(MapDifference(result.disparity, map), "");
    EXPECT_EQ(result.disparity.geometry, (RectifiedGeometry{.width = 20, .height = 16}));
    EXPECT_TRUE(result.depth.depth_m.empty());
    EXPECT_EQ(result.left.Row(0), left.Row(0)) << "it came down for nothing";
  }
}

}  // namespace
}  // namespace vs::gpu
