// Everything on a real device: what the other matchers compute, to the last bit, whatever was in
// its memory before. Skipped where there is none.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "engine/base/str.h"
#include "gpu/cuda_executor.h"
#include "gpu/cuda_matcher.h"
#include "gpu/devices.h"
#include "tests/engine/stereo/map_difference.h"
#include "tests/engine/stereo/pictures.h"
#include "tests/engine/stereo/random_rectification.h"
#include "tests/engine/stereo/random_settings.h"

namespace vs::gpu {
namespace {

using testing::HasSubstr;

// Frames by one executor, compared with a matcher of the processor.
class Comparison {
 public:
  explicit Comparison(uint32_t seed, const char* matcher = "cpu")
      : random_(seed),
        matcher_(*StereoMatchers::Get().Make(matcher)),
        executor_(*MakeCudaExecutor(0, {.poison = true})) {}

  std::mt19937& random() { return random_; }
  RandomPair Pair(int width, int height) { return MakeRandomPair(pool_, width, height, random_); }
  // Where they differ; empty if nowhere.
  std::string Of(const RandomPair& pair, const SgmSettings& settings) {
    return Of(pair, StereoPlan{.settings = settings});
  }
  std::string Of(const RandomPair& pair, const StereoPlan& plan) {
    const auto expected = matcher_->Process(pair.left, pair.right, plan, 2, pool_);
    if (!expected.has_value()) return expected.error().ToString();
    const Status prepared = executor_->Prepare(plan, pair.left.width(), pair.left.height());
    if (!prepared.ok()) return prepared.ToString();
    const auto result = executor_->Run(pair.left, pair.right, pool_);
    if (!result.has_value()) return result.error().ToString();
    const std::string difference = ResultDifference(*result, *expected);
    if (difference.empty()) return "";
    return Str(difference, " at ", pair.left.width(), " x ", pair.left.height(), " px, ",
               Describe(plan.settings));
  }

 private:
  BufferPool pool_;
  std::mt19937 random_;
  std::unique_ptr<StereoMatcher> matcher_;
  std::unique_ptr<Executor> executor_;
};

class Device : public testing::Test {
 protected:
  void SetUp() override {
    if (!Devices().has_value()) GTEST_SKIP() << "no GPU: " << Devices().error().message();
  }
};

TEST_F(Device, EqualsTheReferenceOnSmallRandomPictures) {
  Comparison compare(1, "reference");
  for (int round = 0; round < 60; ++round) {
    const RandomPair pair =
        compare.Pair(16 + Below(compare.random(), 100), 16 + Below(compare.random(), 40));
    ASSERT_EQ(compare.Of(pair, MakeRandomSettings(compare.random(), 256)), "");
  }
}

TEST_F(Device, EqualsTheProcessorFromRawPicturesToDepth) {
  Comparison compare(8);
  std::mt19937& random = compare.random();
  for (int round = 0; round < 60; ++round) {
    const RandomPair pair = compare.Pair(40 + Below(random, 600), 40 + Below(random, 300));
    const RectificationKind kind{.interpolation = static_cast<Interpolation>(round % 3),
                                 .exact = Below(random, 2) == 0,
                                 .half_size = Below(random, 2) == 0,
                                 .wild_px = Below(random, 20)};
    const int width = 16 + Below(random, 600);
    const StereoPlan plan{.rectification = MakeRandomRectification(
                              pair.left, width, 16 + Below(random, 300), random, kind),
                          .settings = MakeRandomSettings(random, 256),
                          .depth = round % 4 != 0};
    ASSERT_EQ(compare.Of(pair, plan), "");
    ASSERT_EQ(compare.Of(pair, plan), "") << "the second time";
  }
}

TEST_F(Device, EqualsTheProcessorOnRandomPicturesAndSettings) {
  Comparison compare(2);
  for (int round = 0; round < 100; ++round) {
    const RandomPair pair =
        compare.Pair(16 + Below(compare.random(), 700), 16 + Below(compare.random(), 300));
    ASSERT_EQ(compare.Of(pair, MakeRandomSettings(compare.random(), 256)), "");
  }
}

TEST_F(Device, EqualsTheProcessorForEveryNumberOfDirections) {
  Comparison compare(3);
  for (const auto& pair : {compare.Pair(648, 482), compare.Pair(200, 333)}) {
    for (int directions = 1; directions <= 8; ++directions) {
      ASSERT_EQ(compare.Of(pair, {.num_disparities = 196, .directions = directions}), "");
    }
  }
}

TEST_F(Device, EqualsTheProcessorForEveryRange) {
  Comparison compare(4);
  const RandomPair pair = compare.Pair(400, 60);
  for (int range = 1; range <= 256; ++range) {
    const int first = std::array{0, -300, 50}[range % 3];
    ASSERT_EQ(compare.Of(pair, {.min_disparity = first, .num_disparities = range}), "");
  }
}

TEST_F(Device, EqualsTheProcessorOnLargePictures) {
  Comparison compare(5);
  ASSERT_EQ(compare.Of(compare.Pair(1296, 966), {.num_disparities = 256, .directions = 8}), "");
  ASSERT_EQ(compare.Of(compare.Pair(kMaxPictureWidth, 40), {.num_disparities = 64}), "");
  ASSERT_EQ(compare.Of(compare.Pair(40, kMaxPictureHeight), {.num_disparities = 30}), "");
}

TEST_F(Device, TwoExecutorsWorkAtOnce) {
  std::vector<std::string> differences(2);
  const auto work = [&](uint32_t which) {
    Comparison compare(10 + which);
    for (int round = 0; round < 40 && differences[which].empty(); ++round) {
      const RandomPair pair = compare.Pair(300 + Below(compare.random(), 100), 100);
      differences[which] = compare.Of(pair, MakeRandomSettings(compare.random(), 256));
    }
  };
  std::thread other(work, 1);
  work(0);
  other.join();
  EXPECT_THAT(differences, testing::Each(""));
}

TEST_F(Device, MapsOutliveTheirExecutorAndShareOneBuffer) {
  BufferPool pool;
  std::mt19937 random(6);
  const RandomPair pair = MakeRandomPair(pool, 100, 50, random);
  auto executor = *MakeCudaExecutor(0, {});
  ASSERT_TRUE(executor->Prepare({}, 100, 50).ok());
  const DisparityMap first = executor->Run(pair.left, pair.right, pool)->disparity;
  const DisparityMap second = executor->Run(pair.left, pair.right, pool)->disparity;
  EXPECT_EQ(first.disparity.buffer().place, Place::kPinned);
  EXPECT_EQ(first.disparity.buffer().owner, first.reason.buffer().owner);
  EXPECT_NE(first.disparity.buffer().owner, second.disparity.buffer().owner);
  EXPECT_EQ(pool.SlabsMade(), 2U) << "the pictures";
  executor.reset();
  EXPECT_EQ(MapDifference(first, second), "");
}

TEST_F(Device, RefusesWhatItHasNoRoomForAndSaysHowMuchIsMissing) {
  const SgmSettings large{.num_disparities = 256, .directions = 8};
  std::vector<std::unique_ptr<Executor>> executors;
  Status prepared;
  while (prepared.ok() && executors.size() < 200) {
    executors.push_back(*MakeCudaExecutor(0, {}));
    prepared = executors.back()->Prepare({.settings = large}, kMaxPictureWidth, kMaxPictureHeight);
  }
  EXPECT_EQ(prepared.code(), StatusCode::kResourceExhausted) << prepared.ToString();
  EXPECT_THAT(prepared.message(), HasSubstr("4096 x 3072 px with 256 disparities need "));
  EXPECT_THAT(prepared.message(), HasSubstr(" are available"));
  executors.erase(executors.begin());
  EXPECT_TRUE(
      executors.back()->Prepare({.settings = large}, kMaxPictureWidth, kMaxPictureHeight).ok());
}

TEST_F(Device, IsAMatcherByItsIndex) {
  RegisterMatchers();
  BufferPool pool;
  std::mt19937 random(7);
  const RandomPair pair = MakeRandomPair(pool, 200, 80, random);
  const auto expected =
      (*StereoMatchers::Get().Make("cpu"))->Match(pair.left, pair.right, {}, 2, pool);
  for (const char* name : {"cuda", "cuda:0", "auto"}) {
    const auto matcher = StereoMatchers::Get().Make(name);
    ASSERT_TRUE(matcher.has_value()) << matcher.error().ToString();
    const auto map = (*matcher)->Match(pair.left, pair.right, {}, 2, pool);
    ASSERT_TRUE(map.has_value()) << map.error().ToString();
    EXPECT_EQ(MapDifference(*map, *expected), "");
    EXPECT_EQ(map->disparity.buffer().place, Place::kPinned) << name;
  }
  EXPECT_EQ(MakeCudaExecutor(1000, {}).error().code(), StatusCode::kNotFound);
}

// Last, because it takes the device from whoever has it.
TEST_F(Device, IsResetAfterAnErrorThatSpoilsItAndLosesNoFrame) {
  BufferPool pool;
  std::mt19937 random(8);
  const RandomPair pair = MakeRandomPair(pool, 200, 80, random);
  const auto expected =
      (*StereoMatchers::Get().Make("cpu"))->Match(pair.left, pair.right, {}, 2, pool);
  const SystemClock clock;
  DeviceBoard board(1);
  int made = 0;
  const auto matcher =
      *MakeCudaMatcher({.make_executor =
                            [&](int device) {
                              return MakeCudaExecutor(device, {.spoil_frame = ++made == 1 ? 3 : 0});
                            },
                        .make_substitute = [] { return StereoMatchers::Get().Make("cpu"); },
                        .clock = &clock,
                        .board = &board},
                       0);
  std::vector<DisparityMap> maps;
  for (int frame = 0; frame < 6; ++frame) {
    const auto map = matcher->Match(pair.left, pair.right, {}, 2, pool);
    ASSERT_TRUE(map.has_value()) << map.error().ToString();
    maps.push_back(*map);
  }
  for (const DisparityMap& map : maps) EXPECT_EQ(MapDifference(map, *expected), "");
  EXPECT_EQ(made, 2);
  EXPECT_TRUE(board.Faults().empty()) << board.Faults()[0].why.ToString();
}

}  // namespace
}  // namespace vs::gpu
