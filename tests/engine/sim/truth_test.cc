#include "engine/sim/truth.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "engine/image/opencv_view.h"
#include "engine/sim/demo_rig.h"
#include "engine/sim/ideal_stereo.h"
#include "engine/sim/ray_cast.h"
#include "engine/sim/scene_camera.h"

namespace vs::sim {
namespace {

constexpr int64_t kInstants[] = {0, 2'300'000'000, 7'000'000'001, 17'500'000'000};

// The plain way: one ray in double precision against everything, at most `far` long (in units of
// its direction). Gives where it ends: 1e9 if nowhere.
double Nearest(Vec3 from, Vec3 direction, int64_t instant_ns) {
  const Scene scene = DemoScene();
  std::vector<Box> boxes = scene.boxes;
  boxes.push_back(DemoPart(instant_ns));
  const Vec3 up = scene.table.axes[2];
  double nearest = Dot(up, scene.table.point_m - from) / Dot(up, direction);
  if (nearest <= 0) nearest = 1e9;
  for (const Box& box : boxes) {
    const Vec3 start = Along(box.axes, from - box.center_m);
    const Vec3 step = Along(box.axes, direction);
    double enter = -1e9;
    double leave = 1e9;
    for (const auto& [p, d, half] : {std::array{start.x, step.x, box.half_size_m.x},
                                     std::array{start.y, step.y, box.half_size_m.y},
                                     std::array{start.z, step.z, box.half_size_m.z}}) {
      const double a = (-half - p) / d;
      const double b = (half - p) / d;
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    if (enter < leave && enter > 0) nearest = std::min(nearest, enter);
  }
  for (const Sphere& sphere : scene.spheres) {
    const Vec3 center = sphere.center_m - from;
    const double a = Dot(direction, direction);
    const double b = Dot(direction, center);
    const double root = b * b - a * (Dot(center, center) - sphere.radius_m * sphere.radius_m);
    if (root > 0 && b > std::sqrt(root)) nearest = std::min(nearest, (b - std::sqrt(root)) / a);
  }
  return nearest;
}

// A rectification as cv::stereoRectify makes it.
struct Rectification {
  explicit Rectification(const StereoRig& rig) {
    const cv::Size size(rig.left.width, rig.left.height);
    const auto& t = rig.right_from_left_translation_m;
    left = Matrices(rig.left);
    right = Matrices(rig.right);
    cv::Mat r1, p1, q;
    cv::stereoRectify(
        left.camera, left.distortion, right.camera, right.distortion, size,
        cv::Mat(3, 3, CV_64F, const_cast<double*>(rig.right_from_left_rotation.data())),
        cv::Vec3d(t[0], t[1], t[2]), left.rotation, right.rotation, left.projection,
        right.projection, q, 0, 0);
    view.geometry = {
        .width = size.width,
        .height = size.height,
        .focal_px = left.projection.at<double>(0, 0),
        .baseline_m = -right.projection.at<double>(0, 3) / right.projection.at<double>(0, 0),
        .cx_px = left.projection.at<double>(0, 2),
        .cy_px = left.projection.at<double>(1, 2),
        .principal_offset_px =
            right.projection.at<double>(0, 2) - left.projection.at<double>(0, 2)};
    std::copy_n(left.rotation.ptr<double>(), 9, view.rectified_from_left.begin());
  }

  struct Camera {
    cv::Mat camera, distortion, rotation, projection;

    cv::Mat Rectify(const GreyImage& raw) const {
      cv::Mat map_x, map_y, rectified;
      const cv::Size size(raw.width(), raw.height());
      cv::initUndistortRectifyMap(camera, distortion, rotation, projection, size, CV_32F, map_x,
                                  map_y);
      cv::remap(CvView(raw), rectified, map_x, map_y, cv::INTER_LINEAR);
      return rectified;
    }
  };
  static Camera Matrices(const CameraModel& c) {
    Camera result;
    result.camera = (cv::Mat_<double>(3, 3) << c.fx_px, 0, c.cx_px, 0, c.fy_px, c.cy_px, 0, 0, 1);
    result.distortion = (cv::Mat_<double>(1, 5) << c.k1, c.k2, c.p1, c.p2, c.k3);
    return result;
  }

  Camera left, right;
  RectifiedView view;
};

struct Agreement {
  double mean_difference = 0;
  double visible_share = 0;
};

// Compares each visible pixel of the left picture with its counterpart in the right one.
Agreement Compare(const cv::Mat& left, const cv::Mat& right, const StereoTruth& truth) {
  double sum = 0;
  double count = 0;
  for (int y = 0; y < left.rows; ++y) {
    for (int x = 0; x < left.cols; ++x) {
      if (truth.visible.Row(y)[x] == 0) continue;
      const float right_x = static_cast<float>(x) - truth.disparity_px.Row(y)[x];
      const int whole = std::min(static_cast<int>(right_x), left.cols - 2);
      const float part = right_x - static_cast<float>(whole);
      const auto* row = right.ptr<uint8_t>(y);
      sum += std::fabs(left.ptr<uint8_t>(y)[x] - (row[whole] * (1 - part) + row[whole + 1] * part));
      ++count;
    }
  }
  return {sum / count, count / left.rows / left.cols};
}

class Truth : public testing::Test {
 protected:
  BufferPool pool_;
};

TEST_F(Truth, AgreesWithRaysCastOneByOne) {
  const Rectification rectification(DemoRig(3));
  const RectifiedGeometry& g = rectification.view.geometry;
  const Rotation rig_from_view = Inverse(rectification.view.rectified_from_left);
  const Vec3 right_eye = Rotate(rig_from_view, {g.baseline_m, 0, 0});
  TruthRenderer renderer(rectification.view);
  for (const int64_t instant : kInstants) {
    const SceneTruth truth = renderer.At(instant, pool_);
    int disagreements = 0;
    for (int y = 0; y < g.height; ++y) {
      for (int x = 0; x < g.width; ++x) {
        const Vec3 ray =
            Rotate(rig_from_view, {(x - g.cx_px) / g.focal_px, (y - g.cy_px) / g.focal_px, 1});
        const double depth = Nearest({}, ray, instant);
        const double disparity = g.focal_px * g.baseline_m / depth - g.principal_offset_px;
        const bool inside = x - disparity >= 0 && x - disparity <= g.width - 1;
        const bool visible =
            inside && Nearest(right_eye, ray * depth - right_eye, instant) > 1 - 1e-4;
        if (std::abs(truth.depth_m.Row(y)[x] - depth) > 1e-5 * depth ||
            std::abs(truth.stereo->disparity_px.Row(y)[x] - disparity) > 1e-3 ||
            (truth.stereo->visible.Row(y)[x] == 255) != visible) {
          ++disagreements;
        }
      }
    }
    // Rays that graze an edge may fall on either side of it.
    EXPECT_LT(disagreements, g.width * g.height / 2000) << "at " << instant;
  }
}

TEST_F(Truth, OfTheTableIsItsPlane) {
  TruthRenderer renderer({IdealGeometry(2)});
  const SceneTruth truth = renderer.At(0, pool_);
  const RectifiedGeometry g = IdealGeometry(2);
  // Through (0, 0, 0.88) m with the normal (0.05, -0.48, -0.86); pixel (600, 40) shows only table.
  const double x = (600 - g.cx_px) / g.focal_px;
  const double y = (40 - g.cy_px) / g.focal_px;
  const double depth = 0.86 * 0.88 / (-0.05 * x + 0.48 * y + 0.86);
  EXPECT_NEAR(truth.depth_m.Row(40)[600], depth, 1e-5);
  EXPECT_NEAR(truth.stereo->disparity_px.Row(40)[600], g.focal_px * 0.12 / depth, 1e-3);
}

TEST_F(Truth, LeavesNoPixelOfThePartOutsideOfItsBounds) {
  for (const Side side : {Side::kLeft, Side::kRight}) {
    const View view = MakeRawView(DemoRig(), side);
    const size_t pixels = view.ray_x.size();
    for (const int64_t instant : kInstants) {
      const Box part = ToView(view, DemoPart(instant));
      std::vector<float> depth(pixels, kNothingM);
      std::vector<uint8_t> hit(pixels, 0);
      CastBox(part, 1,
              {view.ray_x.data(), view.ray_y.data(), static_cast<int>(pixels), depth.data(),
               hit.data()});
      const PixelRect bounds = Bounds(view.camera, part);
      int inside = 0;
      for (int y = bounds.y; y < bounds.y + bounds.height; ++y) {
        for (int x = bounds.x; x < bounds.x + bounds.width; ++x) {
          inside += hit[static_cast<size_t>(y) * view.camera.width + x];
        }
      }
      EXPECT_EQ(inside, std::count(hit.begin(), hit.end(), 1));
      EXPECT_GT(inside, 5000);
    }
  }
}

TEST_F(Truth, MatchesIdealPictures) {
  IdealStereo ideal({.binning = 2, .noise = 0});
  for (const int64_t instant : kInstants) {
    const StereoFrame frame = ideal.Capture(instant, 1, pool_);
    ASSERT_EQ(frame.geometry, IdealGeometry(2));
    const Agreement agreement =
        Compare(CvView(frame.left->image), CvView(frame.right->image), *frame.truth);
    EXPECT_LT(agreement.mean_difference, 3.0);
    EXPECT_GT(agreement.visible_share, 0.85);
  }
}

TEST_F(Truth, MatchesRawPicturesOnceRectified) {
  const StereoRig rig = DemoRig();
  const Rectification rectification(rig);
  SceneCamera left({.rig = rig, .side = Side::kLeft, .noise = {0, 1}});
  SceneCamera right({.rig = rig, .side = Side::kRight, .noise = {0, 1}});
  TruthRenderer renderer(rectification.view, rig);
  GreyImage left_raw(pool_, left.width(), left.height());
  GreyImage right_raw(pool_, right.width(), right.height());
  left.Capture(kInstants[1], left.DefaultSettings(), left_raw);
  right.Capture(kInstants[1], right.DefaultSettings(), right_raw);
  const cv::Mat left_rectified = rectification.left.Rectify(left_raw);
  const cv::Mat right_rectified = rectification.right.Rectify(right_raw);
  const SceneTruth truth = renderer.At(kInstants[1], pool_);
  const Agreement agreement = Compare(left_rectified, right_rectified, *truth.stereo);
  EXPECT_LT(agreement.mean_difference, 3.0);
  EXPECT_GT(agreement.visible_share, 0.8);
  // The rig really needs rectification: raw rows do not correspond.
  const Agreement raw = Compare(CvView(left_raw), CvView(right_raw), *truth.stereo);
  EXPECT_GT(raw.mean_difference, 10.0);
}

TEST_F(Truth, CallsNothingVisibleThatARawCameraDoesNotShow) {
  const StereoRig rig = DemoRig(3);
  Rectification rectification(rig);
  rectification.view.geometry.focal_px *= 0.8;  // zoomed out: the rim lies outside of both pictures
  const SceneTruth with_rig = TruthRenderer(rectification.view, rig).At(0, pool_);
  const SceneTruth without = TruthRenderer(rectification.view).At(0, pool_);
  EXPECT_EQ(with_rig.stereo->visible.Row(1)[200], 0);
  EXPECT_EQ(without.stereo->visible.Row(1)[200], 255);
  EXPECT_EQ(with_rig.stereo->visible.Row(160)[200], 255);
}

}  // namespace
}  // namespace vs::sim
