// The main job from end to end: two GigE Vision cameras on the wire, depth at a client of the C++
// library, measured there against the truth. Prints the figures. With VS_PICTURES set to a folder,
// leaves there the picture that the README shows.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "visionserver/v1/sequence.grpc.pb.h"

#include "client/call.h"
#include "client/client.h"
#include "client/decode_depth.h"
#include "engine/calibration/rectifier.h"
#include "engine/image/png.h"
#include "engine/sim/demo_rig.h"
#include "engine/sim/truth.h"
#include "engine/stereo/color_map.h"
#include "engine/stereo/quality.h"
#include "server/convert/sequence.h"
#include "server/storage/atomic_file.h"
#include "tests/server/vision/demo.h"
#include "tests/support/gevsim.h"
#include "tests/support/stereo_scene.h"
#include "tests/support/temp_folder.h"
#include "tests/support/test_server.h"

namespace vs::test {
namespace {

class GigeDepth : public testing::Test {
 protected:
  // The cameras, then a logged-in client of the server.
  void StartCameras(const std::vector<std::string>& options) {
    auto started = StartGevSim(options);
    ASSERT_TRUE(started.has_value()) << started.error().ToString();
    cameras_ = std::move(*started);
  }
  void Connect() {
    auto connected = client::Client::Connect({.address = server_->address(),
                                              .fingerprint = server_->fingerprint(),
                                              .credential = server_.Token(Role::kEngineer)});
    ASSERT_TRUE(connected.has_value()) << connected.error().message;
    client_ = std::move(*connected);
  }

  // The received frame in the engine's form, so that the engine's measures can be used.
  DisparityMap MapOf(const client::DepthFrame& frame) {
    EXPECT_EQ(client::Quantity::kDisparityPx, frame.quantity);
    EXPECT_EQ(1.0 / kDisparityScale, frame.scale);
    DisparityMap map{.disparity = Image<uint16_t>(pool_, frame.width, frame.height),
                     .offset_px = static_cast<int>(frame.offset),
                     .geometry = {.focal_px = frame.geometry.focal_px,
                                  .baseline_m = frame.geometry.baseline_m,
                                  .cx_px = frame.geometry.cx_px,
                                  .cy_px = frame.geometry.cy_px,
                                  .principal_offset_px = frame.geometry.principal_offset_px}};
    for (int y = 0; y < frame.height; ++y) {
      std::copy_n(&frame.values[static_cast<size_t>(y) * frame.width], frame.width,
                  map.disparity.Row(y));
    }
    return map;
  }

  BufferPool pool_;
  std::unique_ptr<ChildProcess> cameras_;
  TestServer server_{{.tls = true}};
  std::unique_ptr<client::Client> client_;
};

template <class T>
void WritePicture(const std::filesystem::path& path, const Image<T>& picture) {
  const auto png = EncodePng(picture);
  ASSERT_TRUE(png.has_value());
  const std::string_view bytes(reinterpret_cast<const char*>(png->data()), png->size());
  const Status written = WriteFileAtomically(path, bytes);
  ASSERT_TRUE(written.ok()) << written.ToString();
}

// Left: what the camera sees; right: what the server measures.
ColorImage SideBySide(const GreyImage& seen, const ColorImage& measured, BufferPool& pool) {
  ColorImage both(pool, 2 * seen.width(), seen.height());
  for (int y = 0; y < seen.height(); ++y) {
    for (int x = 0; x < seen.width(); ++x) {
      const uint8_t grey = seen.Row(y)[x];
      both.Row(y)[x] = {grey, grey, grey};
      both.Row(y)[seen.width() + x] = measured.Row(y)[x];
    }
  }
  return both;
}

TEST_F(GigeDepth, OfTheDemoIsTrueAtTheClient) {
  StartCameras({"--fps", "5"});
  const Status demo = RestartAsDemo(&server_);
  ASSERT_TRUE(demo.ok()) << demo.ToString();
  Connect();

  const StereoRig rig = sim::DemoRig();
  const Rectifier rectifier = Rectifier::Make(rig, 648, 483).value();
  sim::TruthRenderer truth({rectifier.geometry(), rectifier.rectified_from_left_rotation()}, rig);
  const PixelRect whole = {0, 0, 648, 483};
  const PixelRect table = {40, 440, 560, 40};  // nothing stands on it there, near the camera

  client::DepthStream depth = client_->OpenDepth("stereo_depth/depth");
  DisparityMap map;
  for (int i = 0; i < 5; ++i) {
    const auto frame = depth.Next(kPatience);
    ASSERT_TRUE(frame.has_value()) << frame.error().message;
    map = MapOf(*frame);
    EXPECT_NEAR(rectifier.geometry().focal_px, map.geometry.focal_px, 1e-9);
    EXPECT_NEAR(rectifier.geometry().baseline_m, map.geometry.baseline_m, 1e-12);
    const sim::SceneTruth exact = truth.At(frame->capture_ns, pool_);
    const TruthScore score = *ScoreAgainstTruth(map, *exact.stereo, whole);
    const TruthScore plane = *ScoreAgainstTruth(map, *exact.stereo, table);
    std::printf(
        "frame %d: bad-1 %.2f %% of %lld visible pixels, bad-2 %.2f %%, average %.3f px, depth "
        "bias %.3f %%; table: bad-1 %.2f %%, depth bias %.3f %%\n",
        static_cast<int>(frame->frame_number), score.bad1_percent,
        static_cast<long long>(score.pixels), score.bad2_percent, score.average_error_px,
        score.depth_bias_percent, plane.bad1_percent, plane.depth_bias_percent);
    EXPECT_GT(score.pixels, 200'000);
    EXPECT_LE(score.bad1_percent, 2);
    EXPECT_LT(std::abs(score.depth_bias_percent), 0.2);
    EXPECT_GT(plane.pixels, 15'000);
    EXPECT_LT(std::abs(plane.depth_bias_percent), 0.2);
  }

  if (const char* folder = std::getenv("VS_PICTURES"); folder != nullptr) {
    client::LatestStream pictures =
        client_->OpenStream("stereo_depth/pair", {.codec = client::v1::CODEC_RAW});
    const auto picture = pictures.Next(kPatience);
    ASSERT_TRUE(picture.has_value()) << picture.error().message;
    ASSERT_EQ(648U * 483U, picture->payload().size());
    GreyImage seen(pool_, 648, 483);
    for (int y = 0; y < 483; ++y) {
      std::copy_n(picture->payload().data() + static_cast<ptrdiff_t>(y) * 648, 648,
                  reinterpret_cast<char*>(seen.Row(y)));
    }
    const ColorImage measured = ColorizeDisparity(map, ColorMap::kTurbo, 20, 120, pool_);
    WritePicture(std::filesystem::path(folder) / "stereo_depth.png",
                 SideBySide(seen, measured, pool_));
  }
}

// The cameras show a photographed pair in place of the simulated scene.
TEST_F(GigeDepth, OfAPhotographedPairIsTrueAtTheClient) {
  const auto scene = LoadAloe(pool_);
  if (!scene.has_value()) GTEST_SKIP() << scene.error().ToString();
  const TempFolder photographs;
  WritePicture(photographs / "left.png", scene->left);
  WritePicture(photographs / "right.png", scene->right);
  StartCameras({"--fps", "3", "--noise", "0", "--right-sensitivity", "1", "--folder",
                photographs.path(), "--left-pattern", "left.png", "--right-pattern", "right.png"});
  Connect();

  const std::string trigger = "?TriggerSelector=FrameStart&TriggerMode=On&TriggerSource=Line1";
  SequenceSpec spec;
  spec.id = "photographs";
  spec.blocks = {
      {"cameras",
       "StereoCamera",
       {{"left", "gev-ip:127.0.0.1" + trigger}, {"right", "gev-ip:127.0.0.2" + trigger}}},
      {"match", "SgmStereo", {{"num_disparities", int64_t{scene->num_disparities}}}},
      {"publish", "Publish", {{"stream", std::string("depth")}}}};
  spec.connections = {{"cameras", "pair", "match", "pair"},
                      {"match", "disparity", "publish", "value"}};
  client::v1::CreateSequenceRequest create;
  create.set_id(spec.id);
  *create.mutable_spec() = ToProto(spec);
  const auto created = client::Call(*client_->connection(),
                                    &client::v1::SequenceService::Stub::CreateSequence, create);
  ASSERT_TRUE(created.has_value()) << created.error().message;
  const auto started = client_->StartSequence(spec.id);
  ASSERT_TRUE(started.has_value()) << started.error().message;

  client::DepthStream depth = client_->OpenDepth("photographs/depth");
  std::vector<uint16_t> first;
  for (int i = 0; i < 3; ++i) {
    const auto frame = depth.Next(kPatience);
    ASSERT_TRUE(frame.has_value()) << frame.error().message;
    if (i > 0) {
      // The cameras add no noise, so every frame is the same, and so must be its depth.
      EXPECT_TRUE(frame->values == first) << "frame " << i;
      continue;
    }
    first = frame->values;
    const DisparityMap map = MapOf(*frame);
    const TruthScore score =
        *ScoreAgainstTruth(map, scene->truth, {0, 0, scene->left.width(), scene->left.height()});
    std::printf("%s through two GigE cameras: bad-2 %.2f %%, average %.3f px, valid %.2f %%\n",
                scene->name.c_str(), score.bad2_percent, score.average_error_px,
                score.valid_percent);
    // Its truth has whole pixels of the full size, so that bad-1 means little.
    EXPECT_LE(score.bad2_percent, 4.5);
    if (const char* folder = std::getenv("VS_PICTURES"); folder != nullptr) {
      const ColorImage measured = ColorizeDisparity(map, ColorMap::kTurbo, 15, 110, pool_);
      WritePicture(std::filesystem::path(folder) / "photographs.png",
                   SideBySide(scene->left, measured, pool_));
    }
  }
}

}  // namespace
}  // namespace vs::test
