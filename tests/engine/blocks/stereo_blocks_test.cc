// The blocks from a raw pair to coloured depth, one by one and as a chain.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "engine/base/str.h"
#include "engine/calibration/rig_file.h"
#include "engine/sim/demo_rig.h"
#include "engine/sim/ideal_stereo.h"
#include "engine/stereo/sgm_presets.h"
#include "engine/stereo/stereo_matcher.h"
#include "tests/engine/stereo/map_difference.h"
#include "tests/engine/stereo/pictures.h"
#include "tests/engine/stereo/random_rectification.h"
#include "tests/support/block_harness.h"
#include "tests/support/count_allocations.h"
#include "tests/support/temp_folder.h"

namespace vs {
namespace {

using test::BlockHarness;
using testing::HasSubstr;

template <class T>
std::shared_ptr<const T> Share(T value) {
  return std::make_shared<const T>(std::move(value));
}

// One pair of the simulated scene, shrunk to keep the tests quick.
class StereoBlocks : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    BufferPool pool;
    pair_ = new std::shared_ptr<const StereoFrame>(
        Share(sim::IdealStereo({.binning = 2}).Capture(0, 1, pool)));
  }
  static void TearDownTestSuite() { delete pair_; }
  static std::shared_ptr<const StereoFrame> Pair() { return *pair_; }
  // As a camera gives it: without geometry and truth.
  static std::shared_ptr<const StereoFrame> RawPair() {
    StereoFrame raw = **pair_;
    raw.geometry.reset();
    raw.truth = nullptr;
    return Share(raw);
  }

  std::shared_ptr<const DisparityMap> Match(const std::string& view) {
    BlockHarness match("SgmStereo");
    EXPECT_TRUE(match.Set("view", view).ok());
    match.Input("pair", Pair());
    EXPECT_TRUE(match.Start().ok());
    const Status status = match.Run();
    EXPECT_TRUE(status.ok()) << status.ToString();
    return std::get<std::shared_ptr<const DisparityMap>>(match.Output("disparity").variant());
  }

  static std::shared_ptr<const StereoFrame>* pair_;
};
std::shared_ptr<const StereoFrame>* StereoBlocks::pair_ = nullptr;

TEST_F(StereoBlocks, MatchAndMeasureTheSimulatedScene) {
  const auto disparity = Match("left");
  EXPECT_EQ(disparity->geometry, *Pair()->geometry);

  BlockHarness to_depth("DisparityToDepth");
  to_depth.Input("disparity", disparity);
  ASSERT_TRUE(to_depth.Run().ok());
  const DepthMap& depth = *to_depth.Output<DepthMap>("depth");
  EXPECT_NEAR(depth.depth_m.Row(440)[100], 64.03F / (disparity->disparity.Row(440)[100] / 16.0F),
              0.001);

  BlockHarness quality("DepthQuality");
  for (const auto& [name, value] : {std::pair{"roi_x", int64_t{200}},
                                    {"roi_y", int64_t{380}},
                                    {"roi_width", int64_t{200}},
                                    {"roi_height", int64_t{90}}}) {
    ASSERT_TRUE(quality.Set(name, value).ok());
  }
  quality.Input("disparity", disparity);
  quality.Input("depth", to_depth.Output("depth"));
  quality.Input("pair", Pair());
  ASSERT_TRUE(quality.Run().ok());
  EXPECT_GT(*quality.Output<double>("valid"), 99);
  EXPECT_LT(*quality.Output<double>("plane_rms"), 0.002);
  EXPECT_NEAR(*quality.Output<double>("plane_distance"), 0.767, 0.005);
  EXPECT_LT(*quality.Output<double>("bad1"), 0.5);
  EXPECT_LE(*quality.Output<double>("bad2"), *quality.Output<double>("bad1"));
  EXPECT_LT(*quality.Output<double>("average_error"), 0.15);
  EXPECT_LT(std::abs(*quality.Output<double>("depth_bias")), 0.1);
}

TEST_F(StereoBlocks, QualityWithoutDepthAndTruthGivesOnlyTheValidShare) {
  BlockHarness quality("DepthQuality");
  quality.Input("disparity", Match("left"));
  ASSERT_TRUE(quality.Run().ok());
  EXPECT_GT(*quality.Output<double>("valid"), 85) << "all but the left border";
  EXPECT_TRUE(quality.Output("plane_rms").empty());
  EXPECT_TRUE(quality.Output("bad1").empty());
}

TEST_F(StereoBlocks, BothViewsAgreeAlmostEverywhere) {
  const auto left = Match("left");
  const auto right = Match("right");
  BlockHarness check("LeftRightCheck");
  check.Input("left", left);
  check.Input("right", right);
  ASSERT_TRUE(check.Run().ok());
  const DisparityMap& checked = *check.Output<DisparityMap>("checked");
  int before = 0;
  int after = 0;
  for (int y = 0; y < left->disparity.height(); ++y) {
    for (int x = 0; x < left->disparity.width(); ++x) {
      before += left->disparity.Row(y)[x] != 0 ? 1 : 0;
      after += checked.disparity.Row(y)[x] != 0 ? 1 : 0;
      ASSERT_EQ(checked.disparity.Row(y)[x] == 0, checked.reason.Row(y)[x] != 0);
    }
  }
  EXPECT_LT(after, before);
  EXPECT_GT(after, before * 0.95);
}

TEST_F(StereoBlocks, MatchingNamesWrongParameters) {
  BlockHarness match("SgmStereo");
  match.Input("pair", Pair());
  ASSERT_TRUE(match.Set("p1", int64_t{40}).ok());
  ASSERT_TRUE(match.Set("p2", int64_t{20}).ok());
  EXPECT_THAT(match.Start().ToString(), HasSubstr("p1: is 40; it must be 0 .. p2, which is 20"));
  ASSERT_TRUE(match.Set("p2", int64_t{40}).ok());
  ASSERT_TRUE(match.Start().ok());
  EXPECT_TRUE(match.Run().ok());
  EXPECT_EQ(match.Set("num_disparities", int64_t{257}).code(), StatusCode::kOutOfRange);
  EXPECT_FALSE(match.Set("cost", std::string("ssd")).ok());
}

TEST_F(StereoBlocks, APresetIsTheBaseAndChangedParametersCountOnTop) {
  SgmSettings expected = *ApplySgmPreset("strict");
  expected.p2 = 20;
  expected.census = CensusPattern::k7x7;
  BufferPool pool;
  const auto map = (*StereoMatchers::Get().Make("reference"))
                       ->Match(Pair()->left->image, Pair()->right->image, expected, 2, pool);
  ASSERT_TRUE(map.has_value());

  BlockHarness match("SgmStereo");
  match.Input("pair", Pair());
  ASSERT_TRUE(match.Set("preset", std::string("strict")).ok());
  ASSERT_TRUE(match.Set("p2", int64_t{20}).ok());
  ASSERT_TRUE(match.Set("census", std::string("7x7")).ok());
  ASSERT_TRUE(match.Start().ok());
  ASSERT_TRUE(match.Run().ok());
  EXPECT_EQ(MapDifference(*match.Output<DisparityMap>("disparity"), *map), "");
  EXPECT_THAT(match.Set("preset", std::string("best")).ToString(), HasSubstr("quality"));
}

TEST_F(StereoBlocks, ARegionMasksTheRest) {
  BlockHarness match("SgmStereo");
  match.Input("pair", Pair());
  for (const char* name : {"roi_x", "roi_y", "roi_width"}) {
    ASSERT_TRUE(match.Set(name, int64_t{200}).ok());
  }
  ASSERT_TRUE(match.Start().ok());
  ASSERT_TRUE(match.Run().ok());
  const DisparityMap& map = *match.Output<DisparityMap>("disparity");
  const auto masked = static_cast<uint8_t>(InvalidReason::kMasked);
  EXPECT_EQ(map.reason.Row(199)[300], masked);
  EXPECT_EQ(map.reason.Row(300)[400], masked);
  EXPECT_NE(map.reason.Row(200)[200], masked);
  EXPECT_NE(map.reason.Row(482)[399], masked);
  ASSERT_TRUE(match.Set("roi_x", int64_t{2000}).ok());
  EXPECT_THAT(match.Run().ToString(), HasSubstr("outside the picture"));
}

TEST_F(StereoBlocks, SpeckleFilterLeavesItsInputAlone) {
  const auto disparity = Match("left");
  const auto before = disparity->disparity.Row(240)[324];
  ASSERT_NE(before, kInvalidDisparity);
  BlockHarness filter("SpeckleFilter");
  ASSERT_TRUE(filter.Set("max_size", int64_t{1000000}).ok());
  filter.Input("disparity", disparity);
  ASSERT_TRUE(filter.Run().ok());
  EXPECT_EQ(filter.Output<DisparityMap>("filtered")->disparity.Row(240)[324], kInvalidDisparity);
  EXPECT_EQ(disparity->disparity.Row(240)[324], before);
}

TEST_F(StereoBlocks, ColoursAskForASensibleRange) {
  BlockHarness colors("DisparityColors");
  colors.Input("disparity", Match("left"));
  ASSERT_TRUE(colors.Set("near_px", 40.0).ok());
  ASSERT_TRUE(colors.Set("far_px", 40.0).ok());
  EXPECT_EQ(colors.Start(), InvalidArgument("far_px (40) must be less than near_px (40)"));
  ASSERT_TRUE(colors.Set("far_px", 20.0).ok());
  ASSERT_TRUE(colors.Start().ok());
  for (const char* name : {"grey", "hue", "turbo", "viridis"}) {
    ASSERT_TRUE(colors.Set("colors", std::string(name)).ok());
    ASSERT_TRUE(colors.Run().ok());
    EXPECT_EQ(colors.Output<ColorImage>("picture")->width(), 648);
  }
}

TEST(DepthColors, WantsNearBeforeFar) {
  BlockHarness colors("DepthColors");
  ASSERT_TRUE(colors.Set("near_m", 2.5).ok());
  EXPECT_EQ(colors.Start(), InvalidArgument("near_m (2.5) must be less than far_m (2)"));
  ASSERT_TRUE(colors.Set("far_m", int64_t{3}).ok());
  EXPECT_TRUE(colors.Start().ok());
}

class RectifyBlock : public StereoBlocks {
 protected:
  void SetUp() override {
    block_.environment.folders.data_dir = folder_.path();
    ASSERT_TRUE(SaveRig(sim::DemoRig(), folder_ / "demo.json").ok());
    block_.Input("pair", RawPair());
  }
  test::TempFolder folder_;
  BlockHarness block_{"RectifyPair"};
};

class OneRig final : public RigStore {
 public:
  Result<std::shared_ptr<const StereoRig>> Find(const std::string& name) const override {
    if (name == "cell 3") return Share(sim::DemoRig());
    return NotFound("there is no calibration \"" + name + "\"; there is: cell 3");
  }
};

TEST_F(RectifyBlock, TakesTheRigFromTheStoreOrAFile) {
  const OneRig store;
  block_.environment.rigs = &store;
  ASSERT_TRUE(block_.Set("rig", std::string("cell 3")).ok());
  ASSERT_TRUE(block_.Start().ok());
  ASSERT_TRUE(block_.Run().ok());
  const auto from_store = block_.Output<StereoFrame>("rectified")->geometry;
  ASSERT_TRUE(from_store.has_value());
  EXPECT_EQ(from_store->width, 648);

  ASSERT_TRUE(block_.Set("rig", std::string()).ok());
  ASSERT_TRUE(block_.Set("rig_file", std::string("demo.json")).ok());
  ASSERT_TRUE(block_.Start().ok());
  ASSERT_TRUE(block_.Run().ok());
  EXPECT_EQ(block_.Output<StereoFrame>("rectified")->geometry, from_store);
}

TEST_F(RectifyBlock, ReadsCalibrationsBelowTheDataFolderOnly) {
  block_.environment.folders.data_dir = folder_ / "data";
  for (const std::string& outside :
       {std::string("../demo.json"), (folder_ / "demo.json").string()}) {
    ASSERT_TRUE(block_.Set("rig_file", outside).ok());
    EXPECT_THAT(block_.Start().ToString(), HasSubstr("leads out of the server's data folder"));
  }
}

TEST_F(RectifyBlock, SaysWhichCalibrationIsMissing) {
  EXPECT_THAT(block_.Start().ToString(), HasSubstr("no calibration is chosen"));
  ASSERT_TRUE(block_.Set("rig_file", std::string("gone.json")).ok());
  EXPECT_THAT(block_.Start().ToString(), HasSubstr("gone.json"));
  ASSERT_TRUE(block_.Set("rig", std::string("cell 4")).ok());
  EXPECT_THAT(block_.Start().ToString(), HasSubstr("no store of calibrations"));
  const OneRig store;
  block_.environment.rigs = &store;
  EXPECT_THAT(block_.Start().ToString(), HasSubstr("there is: cell 3"));
}

TEST_F(RectifyBlock, RefusesARectifiedPair) {
  ASSERT_TRUE(block_.Set("rig_file", std::string("demo.json")).ok());
  ASSERT_TRUE(block_.Start().ok());
  block_.Input("pair", Pair());
  EXPECT_EQ(block_.Run().code(), StatusCode::kFailedPrecondition);
}

TEST_F(RectifyBlock, FollowsItsParametersLive) {
  ASSERT_TRUE(block_.Set("rig_file", std::string("demo.json")).ok());
  ASSERT_TRUE(block_.Start().ok());
  ASSERT_TRUE(block_.Run().ok());
  const double narrow = block_.Output<StereoFrame>("rectified")->geometry->focal_px;
  ASSERT_TRUE(block_.Set("alpha", 1.0).ok());
  ASSERT_TRUE(block_.Run().ok());
  EXPECT_LT(block_.Output<StereoFrame>("rectified")->geometry->focal_px, narrow);
}

// The blocks RectifyPair, SgmStereo and DisparityToDepth, and the one that is all three.
class ThreeBlocksAndOne : public RectifyBlock {
 protected:
  void SetUp() override {
    RectifyBlock::SetUp();
    one_.environment.folders.data_dir = folder_.path();
    one_.Input("pair", RawPair());
    ASSERT_TRUE(block_.Set("rig_file", std::string("demo.json")).ok());
    ASSERT_TRUE(one_.Set("rig_file", std::string("demo.json")).ok());
  }
  // To the block that has this parameter, and to the one.
  void Set(BlockHarness* block, const std::string& name, const ParamValue& value) {
    ASSERT_TRUE(block->Set(name, value).ok()) << name;
    ASSERT_TRUE(one_.Set(name, value).ok()) << name;
  }
  void ExpectTheSame() {
    const Status status = one_.Run();
    ASSERT_TRUE(status.ok()) << status.ToString();
    ASSERT_TRUE(block_.Run().ok());
    match_.Input("pair", block_.Output("rectified"));
    ASSERT_TRUE(match_.Run().ok());
    depth_.Input("disparity", match_.Output("disparity"));
    ASSERT_TRUE(depth_.Run().ok());

    const Frame& left = *one_.Output<Frame>("left");
    const Frame& expected = *block_.Output<StereoFrame>("rectified")->left;
    EXPECT_EQ(RowsOf(left.image), RowsOf(expected.image));
    EXPECT_EQ(left.number, expected.number);
    EXPECT_EQ(left.camera, expected.camera);
    const DisparityMap& map = *one_.Output<DisparityMap>("disparity");
    EXPECT_EQ(MapDifference(map, *match_.Output<DisparityMap>("disparity")), "");
    EXPECT_EQ(map.geometry, match_.Output<DisparityMap>("disparity")->geometry);
    EXPECT_EQ(DepthDifference(*one_.Output<DepthMap>("depth"), *depth_.Output<DepthMap>("depth")),
              "");
  }

  BlockHarness match_{"SgmStereo"};
  BlockHarness depth_{"DisparityToDepth"};
  BlockHarness one_{"StereoDepth"};
};

TEST_F(ThreeBlocksAndOne, GiveTheSame) {
  ASSERT_TRUE(block_.Start().ok());
  ASSERT_TRUE(match_.Start().ok());
  ASSERT_TRUE(one_.Start().ok());
  ExpectTheSame();
  Set(&block_, "interpolation", std::string("cubic"));
  Set(&block_, "precision", std::string("float"));
  Set(&block_, "resolution", std::string("half"));
  Set(&match_, "preset", std::string("strict"));
  Set(&match_, "num_disparities", int64_t{48});
  ExpectTheSame();
  Set(&match_, "roi_x", int64_t{100});
  Set(&match_, "roi_height", int64_t{60});
  ExpectTheSame();
}

TEST_F(ThreeBlocksAndOne, RefuseTheSame) {
  ASSERT_TRUE(one_.Set("p1", int64_t{40}).ok());
  ASSERT_TRUE(one_.Set("p2", int64_t{20}).ok());
  EXPECT_THAT(one_.Start().ToString(), HasSubstr("p1: is 40; it must be 0 .. p2, which is 20"));
  ASSERT_TRUE(one_.Set("p2", int64_t{40}).ok());
  ASSERT_TRUE(one_.Set("rig_file", std::string("gone.json")).ok());
  EXPECT_THAT(one_.Start().ToString(), HasSubstr("gone.json"));
  ASSERT_TRUE(one_.Set("rig_file", std::string("demo.json")).ok());
  ASSERT_TRUE(one_.Start().ok());
  one_.Input("pair", Pair());
  EXPECT_THAT(one_.Run().ToString(), HasSubstr("FAILED_PRECONDITION: this pair is rectified"));
}

// A backend that has no room for anything.
class FullMatcher final : public StereoMatcher {
 public:
  Status Reserve(const StereoPlan& plan, int width, int height) override {
    return ResourceExhausted(Str("no room for ", width, " x ", height, " px with ",
                                 plan.settings.num_disparities, " disparities"));
  }
  size_t WorkingBytes() const override { return 0; }

 private:
  Result<DisparityMap> MatchPair(const GreyImage& /*left*/, const GreyImage& /*right*/,
                                 const SgmSettings& /*settings*/, int /*threads*/,
                                 BufferPool& /*pool*/) override {
    return Internal("nobody should get here");
  }
};
VS_REGISTER_MATCHER("full", -1, [] {
  return Result<std::unique_ptr<StereoMatcher>>(std::make_unique<FullMatcher>());
});

TEST_F(ThreeBlocksAndOne, DoNotStartWhereThereIsNoRoom) {
  ASSERT_TRUE(one_.Set("backend", std::string("full")).ok());
  ASSERT_TRUE(one_.Set("num_disparities", int64_t{48}).ok());
  const CameraModel camera = LoadRig(folder_ / "demo.json")->left;
  EXPECT_EQ(one_.Start().ToString(), Str("RESOURCE_EXHAUSTED: no room for ", camera.width, " x ",
                                         camera.height, " px with 48 disparities"));
}

TEST_F(ThreeBlocksAndOne, TakeNoMemoryOnceWarm) {
  ASSERT_TRUE(one_.Start().ok());
  for (int warm_up = 0; warm_up < 4; ++warm_up) ASSERT_TRUE(one_.Run().ok());
  const uint64_t before = test::Allocations();
  ASSERT_TRUE(one_.Run().ok());
  EXPECT_EQ(test::Allocations(), before);
}

// From the second frame on, the chain lives on what it has.
TEST_F(RectifyBlock, TheWarmChainTakesNoMemory) {
  ASSERT_TRUE(block_.Set("rig_file", std::string("demo.json")).ok());
  BlockHarness resize("Resize");
  BlockHarness match("SgmStereo");
  BlockHarness speckle("SpeckleFilter");
  BlockHarness depth("DisparityToDepth");
  BlockHarness quality("DepthQuality");
  BlockHarness colors("DepthColors");
  ASSERT_TRUE(block_.Start().ok());
  ASSERT_TRUE(match.Start().ok());
  const auto run = [&] {
    ASSERT_TRUE(block_.Run().ok());
    resize.Input("pair", block_.Output("rectified"));
    ASSERT_TRUE(resize.Run().ok());
    match.Input("pair", resize.Output("resized"));
    ASSERT_TRUE(match.Run().ok());
    speckle.Input("disparity", match.Output("disparity"));
    ASSERT_TRUE(speckle.Run().ok());
    depth.Input("disparity", speckle.Output("filtered"));
    ASSERT_TRUE(depth.Run().ok());
    quality.Input("disparity", speckle.Output("filtered"));
    quality.Input("depth", depth.Output("depth"));
    ASSERT_TRUE(quality.Run().ok());
    colors.Input("depth", depth.Output("depth"));
    ASSERT_TRUE(colors.Run().ok());
  };
  for (int warm_up = 0; warm_up < 4; ++warm_up) run();
  const uint64_t before = test::Allocations();
  run();
  EXPECT_EQ(test::Allocations(), before);
}

}  // namespace
}  // namespace vs
