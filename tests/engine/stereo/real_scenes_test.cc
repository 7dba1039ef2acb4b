// How good the reference matcher is: on the simulated scene against its exact truth, and on real
// pictures. Prints the figures; the bounds only guard against falling back.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <string>

#include "engine/calibration/rectifier.h"
#include "engine/sim/demo_rig.h"
#include "engine/sim/ideal_stereo.h"
#include "engine/sim/scene_camera.h"
#include "engine/sim/truth.h"
#include "engine/stereo/background_fill.h"
#include "engine/stereo/quality.h"
#include "engine/stereo/stereo_matcher.h"
#include "tests/support/stereo_scene.h"

namespace vs {
namespace {

class RealScenes : public testing::Test {
 protected:
  static PixelRect All(const GreyImage& image) { return {0, 0, image.width(), image.height()}; }

  DisparityMap Match(const GreyImage& left, const GreyImage& right, int num_disparities) {
    auto map = matcher_->Match(left, right, {.num_disparities = num_disparities}, 2, pool_);
    EXPECT_TRUE(map.has_value()) << map.error().ToString();
    return map.has_value() ? *map : DisparityMap{};
  }

  TruthScore ScoreScene(const StereoScene& scene) {
    const DisparityMap map = Match(scene.left, scene.right, scene.num_disparities);
    const TruthScore score = *ScoreAgainstTruth(map, scene.truth, All(scene.left));
    std::printf("%-11s bad-1 %5.2f %%  bad-2 %5.2f %%  average %.3f px  valid %.2f %%\n",
                scene.name.c_str(), score.bad1_percent, score.bad2_percent, score.average_error_px,
                score.valid_percent);
    return score;
  }

  BufferPool pool_;
  std::unique_ptr<StereoMatcher> matcher_ = *StereoMatchers::Get().Make("reference");
};

TEST_F(RealScenes, TheSimulatedSceneComesOutTrue) {
  sim::IdealStereo camera({.binning = 2, .noise = 1, .seed = 1});
  for (const int64_t second : {0, 3, 9}) {
    const StereoFrame pair = camera.Capture(second * 1'000'000'000, 1, pool_);
    DisparityMap map = Match(pair.left->image, pair.right->image, 128);
    map.geometry = *pair.geometry;
    const TruthScore score = *ScoreAgainstTruth(map, *pair.truth, All(pair.left->image));
    std::printf(
        "simulated, %d s: bad-1 %.2f %%  bad-2 %.2f %%  average %.3f px  depth bias %.3f %%\n",
        static_cast<int>(second), score.bad1_percent, score.bad2_percent, score.average_error_px,
        score.depth_bias_percent);
    EXPECT_LE(score.bad1_percent, 0.5);
    EXPECT_LE(score.average_error_px, 0.12);
    EXPECT_LT(std::abs(score.depth_bias_percent), 0.05);
  }
}

// The pictures of the simulated rig's cameras: with distortion, a little turned, of unequal
// sensitivity; rectified by the rig's calibration and compared with the rectified view's truth.
TEST_F(RealScenes, TheSimulatedRigComesOutTrueOnceRectified) {
  constexpr int64_t kInstantNs = 5'000'000'000;
  const StereoRig rig = sim::DemoRig();
  const Rectifier rectifier = Rectifier::Make(rig, 648, 483).value();
  StereoFrame raw;
  for (const auto side : {sim::Side::kLeft, sim::Side::kRight}) {
    const bool left = side == sim::Side::kLeft;
    sim::SceneCamera camera(
        {.rig = rig, .side = side, .sensitivity = left ? 1 : 1.04, .noise = {1, 1}});
    sim::SensorSettings sensor = camera.DefaultSettings();
    sensor.binning_x = sensor.binning_y = 2;
    sensor.width = 648;
    sensor.height = 483;
    auto frame = std::make_shared<Frame>();
    frame->image = GreyImage(pool_, 648, 483);
    camera.Capture(kInstantNs, sensor, frame->image);
    (left ? raw.left : raw.right) = frame;
  }
  const StereoFrame pair = rectifier.Rectify(raw, pool_).value();
  DisparityMap map = Match(pair.left->image, pair.right->image, 128);
  map.geometry = *pair.geometry;
  sim::TruthRenderer renderer({rectifier.geometry(), rectifier.rectified_from_left_rotation()},
                              rig);
  const auto truth = renderer.At(kInstantNs, pool_);
  const TruthScore score = *ScoreAgainstTruth(map, *truth.stereo, All(pair.left->image));
  std::printf("rectified rig: bad-1 %.2f %%  bad-2 %.2f %%  average %.3f px  depth bias %.3f %%\n",
              score.bad1_percent, score.bad2_percent, score.average_error_px,
              score.depth_bias_percent);
  EXPECT_LE(score.bad1_percent, 1);
  EXPECT_LT(std::abs(score.depth_bias_percent), 0.1);
}

TEST_F(RealScenes, AloeComesOutWell) {
  const auto scene = LoadAloe(pool_);
  if (!scene.has_value()) GTEST_SKIP() << scene.error().ToString();
  // Its truth has whole pixels of the full size, so that bad-1 means little.
  EXPECT_LE(ScoreScene(*scene).bad2_percent, 4.5);
}

TEST_F(RealScenes, BenchmarkScenesComeOutWell) {
  // bad-2 with invalid pixels counted as bad, with a margin above what was measured. OpenCV's best
  // settings reach a mean of 6.05 over the first seven.
  const std::map<std::string, double> bounds = {
      {"art", 7.2},      {"cones", 2.7}, {"dolls", 3.0},   {"moebius", 6.5}, {"motorcycle", 4.3},
      {"reindeer", 4.0}, {"wood2", 0.8}, {"kitti46", 9.0}, {"tsukuba", 2.8}};
  const auto folders = StereoSceneFolders();
  if (folders.empty()) GTEST_SKIP() << "set VS_TEST_DATA to a folder with stereo scenes";
  for (const auto& folder : folders) {
    const auto scene = LoadStereoScene(folder, pool_);
    ASSERT_TRUE(scene.has_value()) << scene.error().ToString();
    const auto bound = bounds.find(scene->name);
    if (bound == bounds.end()) continue;
    EXPECT_LE(ScoreScene(*scene).bad2_percent, bound->second) << scene->name;
  }
}

}  // namespace
}  // namespace vs
