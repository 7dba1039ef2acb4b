#include "engine/core/live_parameters.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <map>
#include <thread>
#include <vector>

#include "tests/engine/core/scheduler_fixture.h"

namespace vs {
namespace {

using ::testing::ElementsAre;

std::vector<ParamAssignment> Pair(int64_t value) {
  return {{"left", "offset", value}, {"right", "offset", value}};
}

SequenceSpec PairSpec() {
  SequenceSpec spec = ChainSpec("pair", {"left", "between", "right"});
  spec.max_frames_in_flight = 6;
  return spec;
}

class LiveParametersTest : public SchedulerTest {};

TEST_F(LiveParametersTest, EveryFrameSeesABatchWholeAndFromTheFrameThatWasPromised) {
  MakeWorkers(3);
  std::map<uint64_t, int64_t> left;
  std::map<uint64_t, int64_t> right;
  std::map<uint64_t, uint64_t> revisions;
  ProbeOf("left").run = [&](const StepRun& run) {
    left[run.frame.number] = run.offset;
    return Status();
  };
  ProbeOf("right").run = [&](const StepRun& run) {
    right[run.frame.number] = run.offset;
    revisions[run.frame.number] = run.frame.parameter_revision;
    return Status();
  };
  const auto run = Start(PairSpec());
  std::map<uint64_t, int64_t> promised = {{1, 0}};
  for (int64_t value = 1; value <= 500; ++value) {
    const auto first_frame = run->SetParameters(Pair(value));
    ASSERT_TRUE(first_frame.has_value());
    promised[*first_frame] = value;
    if (value % 3 == 0) std::this_thread::yield();
  }
  ASSERT_TRUE(WaitForFrames(*run, promised.rbegin()->first));
  run->Stop();
  EXPECT_GT(promised.size(), 10u) << "changes landed between many different frames";
  for (const auto& [number, offset] : left) {
    ASSERT_EQ(offset, right.at(number)) << "frame " << number;
    ASSERT_EQ(offset, std::prev(promised.upper_bound(number))->second) << "frame " << number;
    ASSERT_EQ(revisions.at(number), static_cast<uint64_t>(offset));
  }
  EXPECT_EQ(run->Stats().parameter_revision, 500u);
}

TEST_F(LiveParametersTest, ShowsTheNewValuesAtOnce) {
  MakeWorkers(1);
  ProbeOf("source").ready = [] { return false; };
  const auto run = Start(PairSpec());
  EXPECT_EQ(run->SetParameters(Pair(5)).value(), 1u);
  for (int64_t value = 0; value < 1000; ++value) run->SetParameters(Pair(value)).value();
  const std::vector<ParamAssignment> now = run->Parameters();
  EXPECT_EQ(now[2], (ParamAssignment{"left", "offset", int64_t{999}}));
  EXPECT_EQ(now[5], (ParamAssignment{"between", "offset", int64_t{0}}));
}

TEST_F(LiveParametersTest, ChangesNothingWhenOneValueOfABatchIsWrong) {
  MakeWorkers(1);
  ProbeOf("source").ready = [] { return false; };
  const auto run = Start(PairSpec());
  const auto before = run->Parameters();
  const auto refused = run->SetParameters({{"left", "offset", int64_t{1}},
                                           {"right", "offset", int64_t{1001}},
                                           {"right", "fixed", int64_t{2}},
                                           {"right", "speed", 1.0},
                                           {"nobody", "offset", int64_t{1}},
                                           {"left", "offset", int64_t{2}}});
  EXPECT_EQ(refused.error().code(), StatusCode::kInvalidArgument);
  EXPECT_THAT(refused.error().faults(),
              ElementsAre(Fault{"right.offset", "offset must be -1000 to 1000, not 1001"},
                          Fault{"right.fixed", "can only change while the sequence is stopped"},
                          Fault{"right", "there is no parameter \"speed\""},
                          Fault{"sequence", "there is no block \"nobody\""},
                          Fault{"left.offset", "is set twice"}));
  EXPECT_EQ(run->Parameters(), before);
  EXPECT_EQ(run->Stats().parameter_revision, 0u);

  EXPECT_EQ(run->SetParameters({{"right", "fixed", int64_t{2}}}).error().code(),
            StatusCode::kFailedPrecondition);
  run->Stop();
  EXPECT_EQ(run->SetParameters(Pair(1)).error().message(), "sequence pair is not running any more");
}

SequenceSpec LimitsSpec() {
  SequenceSpec spec = ChainSpec("limits", {"step"});
  spec.blocks.push_back({"limits", "TestLimits", {{"probe", std::string("limits")}}});
  spec.connections.push_back(Wire("step.sum", "limits.a"));
  return spec;
}

TEST_F(LiveParametersTest, RefusesValuesThatDoNotGoTogetherAndChangesNothing) {
  MakeWorkers(1);
  ProbeOf("source").ready = [] { return false; };
  const auto run = Start(LimitsSpec());
  const auto before = run->Parameters();
  const auto refused =
      run->SetParameters({{"limits", "low", 11.0}, {"step", "offset", int64_t{1}}});
  EXPECT_EQ(refused.error().code(), StatusCode::kInvalidArgument);
  EXPECT_THAT(refused.error().faults(),
              ElementsAre(Fault{"limits.low", "is 11; it must be at most high, which is 10"}));
  EXPECT_EQ(run->Parameters(), before);
  EXPECT_EQ(run->Stats().parameter_revision, 0u);

  EXPECT_TRUE(
      run->SetParameters({{"limits", "low", 11.0}, {"limits", "high", int64_t{20}}}).has_value());
  EXPECT_FALSE(run->SetParameters({{"limits", "high", 10.0}}).has_value())
      << "low is 11 from now on, though no frame has seen it yet";
}

TEST_F(LiveParametersTest, TwoEditorsTogetherDoNotGetPastACheck) {
  MakeWorkers(1);
  ProbeOf("source").ready = [] { return false; };
  const auto run = Start(LimitsSpec());
  // Gives the other editor every chance to be checked against the same values.
  std::atomic<int> checks = 0;
  ProbeOf("limits").check = [&checks] {
    ++checks;
    for (int i = 0; i < 1000 && checks < 2; ++i) std::this_thread::yield();
  };
  // Each is fine with the initial value of the other limit, both together are not.
  bool low_set = false;
  std::thread other([&] { low_set = run->SetParameters({{"limits", "low", 8.0}}).has_value(); });
  const bool high_set = run->SetParameters({{"limits", "high", 5.0}}).has_value();
  other.join();
  EXPECT_NE(low_set, high_set);
  EXPECT_EQ(checks, 2);
}

TEST(LiveParameters, CountsAnIntegerForANumberAsThatNumber) {
  // No test block has a number parameter that is live, so one is made here.
  class Scale final : public Block {
   public:
    Param<double> factor{this, "factor", {.initial = 1, .doc = "Factor."}};
    Status Run() override { return Status(); }
  };
  static const bool added = BlockRegistry::Get().Add("Scale", {"Test", "Scales."},
                                                     [] { return std::make_unique<Scale>(); });
  ASSERT_TRUE(added);
  SequenceSpec spec;
  spec.id = "scale";
  spec.blocks = {{"scale", "Scale", {}}};
  const auto sequence = Sequence::Load(spec, 1).value();
  LiveParameters parameters(sequence.get());
  FrameContext frame;
  parameters.Stamp(&frame);
  const uint64_t hash = frame.parameter_hash;
  parameters.Change({{"scale", "factor", int64_t{1}}}, 1);
  EXPECT_EQ(parameters.Values(), sequence->Parameters());
  parameters.Stamp(&frame);
  EXPECT_EQ(frame.parameter_hash, hash);
}

}  // namespace
}  // namespace vs
