#include <gtest/gtest.h>

#include <cmath>

#include "engine/sim/demo_rig.h"
#include "engine/sim/scene_camera.h"

namespace vs::sim {
namespace {

uint64_t Fingerprint(const GreyImage& image) {  // FNV-1a
  uint64_t hash = 0xcbf29ce484222325;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) hash = (hash ^ image.Row(y)[x]) * 0x100000001b3;
  }
  return hash;
}

double Mean(const GreyImage& image) {
  double sum = 0;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) sum += image.Row(y)[x];
  }
  return sum / image.width() / image.height();
}

// Binning 3 makes a rig of 432 x 322 pixels, so that the tests are quick.
class Pictures : public testing::Test {
 protected:
  SceneCamera Camera(double noise, Side side = Side::kLeft) {
    return SceneCamera({.rig = DemoRig(3), .side = side, .noise = {noise, 1}});
  }
  GreyImage Take(SceneCamera& camera, const SensorSettings& settings, int64_t instant_ns = 0) {
    GreyImage picture(pool_, settings.width, settings.height);
    camera.Capture(instant_ns, settings, picture);
    return picture;
  }

  BufferPool pool_;
};

// Run twice: with the functions that this CPU is best at, and with those of the plainest CPU.
TEST_F(Pictures, AreTheSameToTheLastBitOnEveryCpu) {
  SceneCamera left({.rig = DemoRig(), .side = Side::kLeft, .noise = {1, 7}});
  SceneCamera right({.rig = DemoRig(), .side = Side::kRight, .sensitivity = 1.03, .noise = {1, 7}});
  SensorSettings settings = left.DefaultSettings();
  EXPECT_EQ(Fingerprint(Take(left, settings, 0)), 6617974856617982816u);
  EXPECT_EQ(Fingerprint(Take(right, settings, 5'123'456'789)), 12289339567756367996u);
  settings.binning_x = settings.binning_y = 2;
  settings.width /= 2;
  settings.height /= 2;
  settings.gain_raw = 77;
  settings.exposure_us = 6123;
  settings.black_level_raw = 40;
  EXPECT_EQ(Fingerprint(Take(right, settings, 1'000'000'000'000'000'003)), 15667930967838151868u);
}

TEST_F(Pictures, DependOnInstantSideAndSeedOnly) {
  SceneCamera camera = Camera(1);
  SceneCamera same = Camera(1);
  SceneCamera other_seed({.rig = DemoRig(3), .noise = {1, 2}});
  const SensorSettings settings = camera.DefaultSettings();
  Take(camera, settings, 77);  // what was looked at before leaves no trace
  const uint64_t first = Fingerprint(Take(camera, settings, 1000));
  EXPECT_EQ(Fingerprint(Take(same, settings, 1000)), first);
  EXPECT_NE(Fingerprint(Take(camera, settings, 1001)), first);
  EXPECT_NE(Fingerprint(Take(other_seed, settings, 1000)), first);
}

TEST_F(Pictures, RepeatAfterThePartsPeriodOf24Seconds) {
  SceneCamera camera = Camera(0);
  const SensorSettings settings = camera.DefaultSettings();
  const uint64_t start = Fingerprint(Take(camera, settings, 3'000'000'000));
  EXPECT_NE(Fingerprint(Take(camera, settings, 4'000'000'000)), start);
  EXPECT_EQ(Fingerprint(Take(camera, settings, 27'000'000'000)), start);
  EXPECT_EQ(Fingerprint(Take(camera, settings, -21'000'000'000)), start);
}

TEST_F(Pictures, GetBrighterWithExposureAndGain) {
  SceneCamera camera = Camera(0);
  SensorSettings settings = camera.DefaultSettings();
  settings.exposure_us = 2500;
  const double dim = Mean(Take(camera, settings));
  settings.exposure_us = 5000;
  EXPECT_NEAR(Mean(Take(camera, settings)), 2 * dim, 0.01 * dim);
  settings.exposure_us = 2500;
  settings.gain_raw = 168;  // 168 * 0.0359 dB = 6.03 dB, a factor of 2.002
  EXPECT_NEAR(Mean(Take(camera, settings)), 2.002 * dim, 0.01 * dim);
}

TEST_F(Pictures, AddTheBlackLevelAndSaturate) {
  SceneCamera camera = Camera(0);
  SensorSettings settings = camera.DefaultSettings();
  settings.exposure_us = kMinExposureUs;
  EXPECT_LT(Mean(Take(camera, settings)), 0.5);
  settings.black_level_raw = 320;  // 20 grey levels
  EXPECT_NEAR(Mean(Take(camera, settings)), 20, 0.5);
  settings.exposure_us = kMaxExposureUs;
  EXPECT_GT(Mean(Take(camera, settings)), 254.9);
}

TEST_F(Pictures, HaveReadAndShotNoiseThatDiffersFromPictureToPicture) {
  SceneCamera noisy = Camera(1);
  SensorSettings dark = noisy.DefaultSettings();
  dark.exposure_us = kMinExposureUs;
  dark.black_level_raw = 320;
  const GreyImage a = Take(noisy, dark, 1);
  const GreyImage b = Take(noisy, dark, 2);
  double square = 0;
  for (int y = 0; y < a.height(); ++y) {
    for (int x = 0; x < a.width(); ++x) square += std::pow(a.Row(y)[x] - b.Row(y)[x], 2);
  }
  // Two pictures with 0.8 levels of read noise and the 0.29 of rounding each.
  EXPECT_NEAR(std::sqrt(square / a.width() / a.height()), std::sqrt(2 * (0.8 * 0.8 + 1 / 12.0)),
              0.05);
}

TEST_F(Pictures, AWindowShowsWhatTheWholePictureShowsThere) {
  SceneCamera camera = Camera(1);
  const SensorSettings whole = camera.DefaultSettings();
  SensorSettings window = whole;
  window.offset_x = 101;
  window.offset_y = 53;
  window.width = 150;
  window.height = 99;
  const GreyImage all = Take(camera, whole);
  const GreyImage part = Take(camera, window);
  for (int y = 0; y < window.height; ++y) {
    for (int x = 0; x < window.width; ++x) {
      ASSERT_EQ(part.Row(y)[x], all.Row(y + 53)[x + 101]) << x << ", " << y;
    }
  }
}

TEST_F(Pictures, BinningAveragesTheLightOfPhotosites) {
  SceneCamera camera = Camera(0);
  const SensorSettings whole = camera.DefaultSettings();
  const GreyImage all = Take(camera, whole);
  for (const auto& [nx, ny] : {std::pair(2, 2), std::pair(1, 2), std::pair(3, 4)}) {
    SensorSettings binned = whole;
    binned.binning_x = nx;
    binned.binning_y = ny;
    binned.width /= nx;
    binned.height /= ny;
    const GreyImage small = Take(camera, binned);
    for (int y = 0; y < binned.height; ++y) {
      for (int x = 0; x < binned.width; ++x) {
        double sum = 0;
        for (int j = 0; j < ny; ++j) {
          for (int i = 0; i < nx; ++i) sum += all.Row(y * ny + j)[x * nx + i];
        }
        ASSERT_NEAR(small.Row(y)[x], sum / (nx * ny), 1.01) << x << ", " << y;
      }
    }
  }
}

}  // namespace
}  // namespace vs::sim
