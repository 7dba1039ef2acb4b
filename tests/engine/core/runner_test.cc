#include "engine/core/runner.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "engine/base/clock.h"
#include "tests/engine/core/test_blocks.h"

namespace vs {
namespace {

// source -> one -> two, source -> two.b
class Runner : public ::testing::Test {
 protected:
  Runner() {
    SequenceSpec spec = ChainSpec("line", {"one", "two"});
    spec.connections.push_back(Wire("source.value", "two.b"));
    sequence_ = Sequence::Load(spec, 4).value();
    RunInfo info{"line", 4, {"source", "one", "two"}};
    frame_ = std::make_unique<FrameInFlight>(*sequence_, std::make_shared<const RunInfo>(info));
    frame_->Begin(*sequence_, 1);
    taps_ = Taps(*sequence_, topics_);
  }
  ~Runner() override { ClearProbes(); }

  BlockOutcome Run(int node) {
    return RunBlock(sequence_->nodes()[node], node, clock_, taps_, frame_.get());
  }
  const Value& SlotOf(int node) const {
    return frame_->slots[sequence_->nodes()[node].first_output_slot];
  }

  SystemClock clock_;
  std::unique_ptr<Sequence> sequence_;
  std::unique_ptr<FrameInFlight> frame_;
  TopicHub topics_;
  Taps taps_;
};

TEST_F(Runner, CarriesValuesAndFreesThemWithTheirLastReader) {
  int64_t seen = 0;
  ProbeOf("two").run = [&seen](const StepRun& run) {
    seen = run.a + 100 * run.b.value_or(0);
    return Status();
  };
  EXPECT_EQ(Run(0).kind, BlockOutcome::Kind::kGood);
  EXPECT_EQ(*SlotOf(0).GetIf<int64_t>(), 1);
  Run(1);
  EXPECT_FALSE(SlotOf(0).empty()) << "two.b has not seen it";
  Run(2);
  EXPECT_EQ(seen, 101);
  EXPECT_TRUE(SlotOf(0).empty());
  EXPECT_TRUE(SlotOf(1).empty());
  EXPECT_TRUE(SlotOf(2).empty()) << "nobody reads it, so it is not kept";
  EXPECT_TRUE(sequence_->nodes()[2].block->FindInput("a")->Release().empty());
}

TEST_F(Runner, OffersOutputsToWhoeverListens) {
  const auto topic = topics_.Find("line/two.sum");
  ASSERT_NE(topic, nullptr);
  std::vector<int64_t> heard;
  const auto run_frame = [&](uint64_t number) {
    frame_->Begin(*sequence_, number);
    for (int node = 0; node < 3; ++node) Run(node);
  };
  run_frame(1);
  auto handle = topic->Listen(
      [&](const auto& sample) { heard.push_back(*sample->value.template GetIf<int64_t>()); });
  run_frame(2);
  ProbeOf("two").run = [](const StepRun&) { return InvalidArgument("too dark"); };
  run_frame(3);
  ProbeOf("two").run = nullptr;
  handle = nullptr;
  run_frame(4);
  // The source counts 1, 2, 3 ..., and two.sum is one.sum and the source's count.
  EXPECT_EQ(heard, (std::vector<int64_t>{4}));
  EXPECT_TRUE(SlotOf(2).empty()) << "a tap keeps nothing in the frame";
}

TEST_F(Runner, TimesTheBlock) {
  Run(0);
  const BlockTime& time = frame_->context.block_times[0];
  EXPECT_GT(time.start_ns, 0);
  EXPECT_GE(time.end_ns, time.start_ns);
  EXPECT_EQ(frame_->context.block_times[1].end_ns, 0);
}

TEST_F(Runner, SkipsABlockWithoutItsRequiredInput) {
  ProbeOf("one").run = [](const StepRun&) { return InvalidArgument("too dark"); };
  Run(0);
  const BlockOutcome error = Run(1);
  EXPECT_EQ(error.kind, BlockOutcome::Kind::kError);
  EXPECT_EQ(error.status, InvalidArgument("too dark"));
  EXPECT_EQ(Run(2).kind, BlockOutcome::Kind::kSkipped);
  EXPECT_TRUE(SlotOf(0).empty()) << "also a skipped block lets go of its inputs";
}

TEST_F(Runner, TurnsExceptionsIntoAStatus) {
  ProbeOf("source").run = [](const StepRun&) -> Status { throw std::runtime_error("boom"); };
  const BlockOutcome outcome = Run(0);
  EXPECT_EQ(outcome.kind, BlockOutcome::Kind::kException);
  EXPECT_EQ(outcome.status, Internal("exception: boom"));
  ProbeOf("source").run = [](const StepRun&) -> Status { throw 7; };
  EXPECT_EQ(Run(0).status, Internal("exception of an unknown type"));
}

TEST_F(Runner, BeginsEachFrameEmpty) {
  Run(0);
  frame_->Clear();
  frame_->Begin(*sequence_, 2);
  EXPECT_TRUE(SlotOf(0).empty());
  EXPECT_EQ(frame_->context.number, 2u);
  EXPECT_EQ(frame_->context.block_times[0].end_ns, 0);
  EXPECT_EQ(frame_->readers_left[0], 2);
}

TEST(RunBlock, GivesAnIntegerToANumberInput) {
  SequenceSpec spec = ChainSpec("line", {});
  spec.blocks.push_back({"half", "TestNumber", {}});
  spec.blocks.push_back({"keep", "TestSome", {}});
  spec.connections = {Wire("source.value", "half.in"), Wire("half.out", "keep.a")};
  const auto sequence = Sequence::Load(spec, 1).value();
  FrameInFlight frame(*sequence, std::make_shared<const RunInfo>());
  frame.Begin(*sequence, 1);
  const SystemClock clock;
  for (int node = 0; node < 2; ++node)
    RunBlock(sequence->nodes()[node], node, clock, Taps(), &frame);
  EXPECT_EQ(*frame.slots[1].GetIf<double>(), 0.5);
}

}  // namespace
}  // namespace vs
