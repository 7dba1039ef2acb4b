#include <gtest/gtest.h>

#include <cmath>

#include <opencv2/calib3d.hpp>

#include "engine/image/opencv_view.h"
#include "engine/sim/ideal_stereo.h"

namespace vs::sim {
namespace {

// OpenCV's matcher stands for any: what it gets right with ordinary settings and 128 disparities,
// the scene makes possible.
TEST(DemoScene, CanBeMatchedAlmostEverywhere) {
  constexpr int kDisparities = 128;
  BufferPool pool;
  const StereoFrame frame = IdealStereo({.binning = 2}).Capture(2'300'000'000, 1, pool);
  const auto matcher = cv::StereoSGBM::create(0, kDisparities, 5, 8 * 25, 32 * 25, 1, 31, 10, 100,
                                              2, cv::StereoSGBM::MODE_SGBM);
  cv::Mat disparity;
  matcher->compute(CvView(frame.left->image), CvView(frame.right->image), disparity);
  int visible = 0;
  int missing = 0;
  int bad = 0;
  double bias = 0;
  for (int y = 0; y < disparity.rows; ++y) {
    for (int x = kDisparities; x < disparity.cols; ++x) {
      if (frame.truth->visible.Row(y)[x] == 0) continue;
      ++visible;
      const double truth = frame.truth->disparity_px.Row(y)[x];
      const double found = disparity.at<short>(y, x) / 16.0;
      EXPECT_LT(truth, kDisparities - 8);
      if (found < 0) {
        ++missing;
      } else if (std::abs(found - truth) > 1) {
        ++bad;
      } else {
        bias += found / truth - 1;
      }
    }
  }
  std::printf("of %d visible pixels %.2f %% missing, %.2f %% bad; mean bias %.3f %%\n", visible,
              100.0 * missing / visible, 100.0 * bad / visible, 100 * bias / visible);
  EXPECT_LT(bad + missing, 0.02 * visible);
  EXPECT_LT(std::abs(bias / visible), 0.002);
}

}  // namespace
}  // namespace vs::sim
