// What becomes of frames when a device fails. The device is a fake; the substitute is the real
// reference matcher.
#include "gpu/cuda_matcher.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "engine/stereo/refine.h"
#include "engine/stereo/selection.h"
#include "tests/engine/stereo/map_difference.h"
#include "tests/engine/stereo/pictures.h"
#include "tests/support/fake_clock.h"

namespace vs::gpu {
namespace {

using std::chrono::seconds;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// What fake devices did and will do.
struct FakeDevices {
  std::deque<Status> outcomes;       // of the next frames; then all succeed
  std::deque<Status> make_outcomes;  // of the next executors; then all are made
  std::deque<Status> room;           // of the next preparations; then there is room
  std::map<int, int> made;           // executors by device
  std::map<int, int> frames;         // by device
  int alive = 0;

  static Status Next(std::deque<Status>* outcomes) {
    if (outcomes->empty()) return {};
    Status next = outcomes->front();
    outcomes->pop_front();
    return next;
  }
};

constexpr uint16_t kOnDevice = 777;  // the disparity of each pixel that a fake device matched

class FakeExecutor final : public Executor {
 public:
  FakeExecutor(FakeDevices* devices, int device) : devices_(devices), device_(device) {
    ++devices_->alive;
  }
  ~FakeExecutor() override { --devices_->alive; }
  FakeExecutor(const FakeExecutor&) = delete;
  FakeExecutor& operator=(const FakeExecutor&) = delete;

  Status Prepare(const StereoPlan& plan, int /*width*/, int /*height*/) override {
    settings_ = plan.settings;
    return FakeDevices::Next(&devices_->room);
  }
  Result<StereoResult> Run(const GreyImage& left, const GreyImage& /*right*/,
                           BufferPool& pool) override {
    ++devices_->frames[device_];
    VS_RETURN_IF_ERROR(FakeDevices::Next(&devices_->outcomes));
    DisparityMap map =
        MakeDisparityMap(left.width(), left.height(), DisparityOffset(settings_), pool);
    map.disparity.Fill(kOnDevice);
    return StereoResult{.left = left, .disparity = map};
  }
  size_t DeviceBytes() const override { return 1234; }
  int64_t StagesNs() const override { return 0; }

 private:
  FakeDevices* devices_;
  int device_;
  SgmSettings settings_;
};

class CudaMatcherTest : public testing::Test {
 protected:
  CudaMatcherOptions Options() {
    return {.make_executor = [this](int device) -> Result<std::unique_ptr<Executor>> {
              VS_RETURN_IF_ERROR(FakeDevices::Next(&devices_.make_outcomes));
              ++devices_.made[device];
              return std::make_unique<FakeExecutor>(&devices_, device);
            },
            .make_substitute = [this]() -> Result<std::unique_ptr<StereoMatcher>> {
              VS_RETURN_IF_ERROR(FakeDevices::Next(&substitute_outcomes_));
              ++substitutes_;
              return StereoMatchers::Get().Make("reference");
            },
            .clock = &clock_,
            .board = &board_};
  }
  void Start(int device = DeviceBoard::kAny) { matcher_ = *MakeCudaMatcher(Options(), device); }

  Result<DisparityMap> Frame() {
    return matcher_->Match(pair_.left, pair_.right, settings_, 1, pool_);
  }
  // "device" or "substitute", or what went wrong.
  std::string WhoMatched() {
    const Result<DisparityMap> map = Frame();
    if (!map.has_value()) return map.error().ToString();
    if (map->disparity.Row(0)[0] == kOnDevice) return "device";
    const auto reference = *StereoMatchers::Get().Make("reference");
    const auto expected = reference->Match(pair_.left, pair_.right, settings_, 1, pool_);
    const std::string difference = MapDifference(*map, *expected);
    return difference.empty() ? "substitute" : difference;
  }

  const Status broken_ = Unavailable("launch: cudaErrorIllegalAddress on GPU 0");
  BufferPool pool_;
  std::mt19937 random_{20261123};
  RandomPair pair_ = MakeRandomPair(pool_, 48, 20, random_);
  SgmSettings settings_{.num_disparities = 16};
  test::FakeClock clock_;
  FakeDevices devices_;
  int substitutes_ = 0;
  std::deque<Status> substitute_outcomes_;  // of the next ones; then all are made
  DeviceBoard board_{2};
  std::unique_ptr<StereoMatcher> matcher_;
};

TEST_F(CudaMatcherTest, FramesGoToTheDevice) {
  Start();
  for (int frame = 0; frame < 3; ++frame) EXPECT_EQ(WhoMatched(), "device");
  EXPECT_EQ(devices_.made[0], 1);
  EXPECT_EQ(matcher_->WorkingBytes(), 1234U);
  EXPECT_EQ(substitutes_, 0) << "the memory of one that nobody needs";
}

TEST_F(CudaMatcherTest, RefusesPicturesForWhichThereIsNoRoomAndGoesOnWithOthers) {
  Start();
  devices_.room = {ResourceExhausted("needs 9000 bytes, 80 are free")};
  EXPECT_THAT(WhoMatched(), HasSubstr("RESOURCE_EXHAUSTED: needs 9000 bytes, 80 are free"));
  EXPECT_EQ(WhoMatched(), "device");
  EXPECT_EQ(devices_.made[0], 1);
  EXPECT_THAT(board_.Faults(), IsEmpty());
}

TEST_F(CudaMatcherTest, ADeviceThatFailsIsMadeAnewAndGetsTheSameFrame) {
  Start();
  devices_.outcomes = {{}, broken_};
  EXPECT_EQ(WhoMatched(), "device");
  EXPECT_EQ(WhoMatched(), "device");
  EXPECT_EQ(devices_.made[0], 2);
  EXPECT_EQ(devices_.alive, 1);
  EXPECT_EQ(devices_.frames[0], 3);
  EXPECT_THAT(board_.Faults(), IsEmpty());
}

TEST_F(CudaMatcherTest, NoFrameIsLostToADeviceThatFailsTwice) {
  Start();
  devices_.outcomes = {broken_, broken_};
  EXPECT_EQ(WhoMatched(), "substitute");
  EXPECT_EQ(devices_.alive, 0);
  ASSERT_EQ(board_.Faults().size(), 1U);
  EXPECT_EQ(board_.Faults()[0].device, 0);
  EXPECT_EQ(board_.Faults()[0].matchers, 1);
  EXPECT_EQ(board_.Faults()[0].why, broken_);
  EXPECT_EQ(WhoMatched(), "substitute");
  EXPECT_EQ(devices_.frames[0], 2) << "the device is left alone";
  EXPECT_GT(matcher_->WorkingBytes(), 1234U);
}

TEST_F(CudaMatcherTest, ADeviceThatFailsAgainWithinAMinuteIsGivenUp) {
  Start();
  devices_.outcomes = {broken_, {}, broken_};
  EXPECT_EQ(WhoMatched(), "device");
  clock_.Advance(seconds(59));
  EXPECT_EQ(WhoMatched(), "substitute");
  EXPECT_EQ(devices_.made[0], 2);
}

TEST_F(CudaMatcherTest, AFailureIsForgottenAfterAMinute) {
  Start();
  devices_.outcomes = {broken_, {}, broken_};
  EXPECT_EQ(WhoMatched(), "device");
  clock_.Advance(seconds(60));
  EXPECT_EQ(WhoMatched(), "device");
  EXPECT_EQ(devices_.made[0], 3);
}

TEST_F(CudaMatcherTest, TheDeviceIsTriedEachMinuteUntilItWorks) {
  Start();
  devices_.outcomes = {broken_, broken_, broken_};
  EXPECT_EQ(WhoMatched(), "substitute");
  clock_.Advance(seconds(60));
  EXPECT_EQ(WhoMatched(), "substitute");
  EXPECT_EQ(devices_.frames[0], 3);
  clock_.Advance(seconds(59));
  EXPECT_EQ(WhoMatched(), "substitute");
  EXPECT_EQ(devices_.frames[0], 3);
  EXPECT_EQ(board_.Faults().size(), 1U);
  clock_.Advance(seconds(1));
  EXPECT_EQ(WhoMatched(), "device");
  EXPECT_EQ(WhoMatched(), "device");
  EXPECT_THAT(board_.Faults(), IsEmpty());
  EXPECT_EQ(substitutes_, 1);
}

TEST_F(CudaMatcherTest, WhoeverHasASubstituteLosesNoFrameToADeviceThatIsFull) {
  Start();
  devices_.outcomes = {broken_, broken_};
  EXPECT_EQ(WhoMatched(), "substitute");
  clock_.Advance(seconds(60));
  devices_.room = {ResourceExhausted("full")};
  EXPECT_EQ(WhoMatched(), "substitute");
  clock_.Advance(seconds(60));
  devices_.make_outcomes = {ResourceExhausted("full")};
  EXPECT_EQ(WhoMatched(), "substitute");
}

TEST_F(CudaMatcherTest, AFullDeviceThatCannotBeMadeAnewLosesNoFrame) {
  Start();
  devices_.outcomes = {broken_};
  devices_.make_outcomes = {ResourceExhausted("full")};
  EXPECT_EQ(WhoMatched(), "substitute");
  EXPECT_EQ(WhoMatched(), "substitute");
}

TEST_F(CudaMatcherTest, ADeviceThatIsBrokenAtTheStartIsDoneWithout) {
  devices_.make_outcomes = {broken_};
  Start(1);
  ASSERT_EQ(board_.Faults().size(), 1U);
  EXPECT_EQ(board_.Faults()[0].device, 1);
  EXPECT_EQ(WhoMatched(), "substitute");
  matcher_.reset();
  EXPECT_THAT(board_.Faults(), IsEmpty()) << "whoever starts anew tells it anew";
}

TEST_F(CudaMatcherTest, AFullDeviceIsRefusedAtTheStart) {
  devices_.make_outcomes = {ResourceExhausted("needs 500 MB, 3 are free")};
  const auto matcher = MakeCudaMatcher(Options(), 0);
  ASSERT_FALSE(matcher.has_value());
  EXPECT_EQ(matcher.error().code(), StatusCode::kResourceExhausted);
}

TEST_F(CudaMatcherTest, TellsAtTheStartThatThereIsNoRoom) {
  Start();
  devices_.room = {ResourceExhausted("needs 500 MB, 3 are free"), broken_};
  const Status full = matcher_->Reserve({.settings = settings_}, 640, 480);
  EXPECT_EQ(full.ToString(), "RESOURCE_EXHAUSTED: needs 500 MB, 3 are free");
  EXPECT_TRUE(matcher_->Reserve({.settings = settings_}, 640, 480).ok())
      << "the frame deals with it";
  EXPECT_TRUE(matcher_->Reserve({.settings = settings_}, 640, 480).ok());
  EXPECT_EQ(WhoMatched(), "device");
}

TEST_F(CudaMatcherTest, AFullDeviceIsPassedOverWhileThereAreOthers) {
  devices_.make_outcomes = {ResourceExhausted("GPU 0 is full")};
  Start();
  EXPECT_EQ(devices_.made, (std::map<int, int>{{1, 1}}));
  devices_.make_outcomes = {ResourceExhausted("GPU 0 is full"), ResourceExhausted("GPU 1 is full")};
  const auto matcher = MakeCudaMatcher(Options(), DeviceBoard::kAny);
  ASSERT_FALSE(matcher.has_value());
  EXPECT_EQ(matcher.error().message(), "GPU 1 is full");
}

TEST_F(CudaMatcherTest, OnlyFramesAreLostWhileThereIsNoSubstituteEither) {
  Start();
  devices_.outcomes = {broken_, broken_};
  substitute_outcomes_ = {ResourceExhausted("no memory for threads")};
  EXPECT_EQ(WhoMatched(), "RESOURCE_EXHAUSTED: no memory for threads");
  EXPECT_EQ(WhoMatched(), "substitute");
}

TEST_F(CudaMatcherTest, MatchersSpreadOverTheDevices) {
  Start();
  auto second = *MakeCudaMatcher(Options(), DeviceBoard::kAny);
  auto third = *MakeCudaMatcher(Options(), DeviceBoard::kAny);
  EXPECT_EQ(devices_.made, (std::map<int, int>{{0, 2}, {1, 1}}));
  matcher_.reset();
  third.reset();
  auto named = *MakeCudaMatcher(Options(), 1);
  auto fourth = *MakeCudaMatcher(Options(), DeviceBoard::kAny);
  EXPECT_EQ(devices_.made, (std::map<int, int>{{0, 3}, {1, 2}}));
}

TEST_F(CudaMatcherTest, ADeviceThatFailsIsNobodysFirstChoice) {
  devices_.make_outcomes = {broken_};
  Start(0);
  auto second = *MakeCudaMatcher(Options(), DeviceBoard::kAny);
  auto third = *MakeCudaMatcher(Options(), DeviceBoard::kAny);
  EXPECT_EQ(devices_.made, (std::map<int, int>{{1, 2}}));
}

TEST_F(CudaMatcherTest, ADeviceThatIsNotThereIsNamed) {
  const auto matcher = MakeCudaMatcher(Options(), 2);
  ASSERT_FALSE(matcher.has_value());
  EXPECT_EQ(matcher.error().ToString(),
            "NOT_FOUND: there is no GPU 2; this machine has 2, from 0 to 1");
}

}  // namespace
}  // namespace vs::gpu
