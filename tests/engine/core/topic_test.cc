#include "engine/core/topic.h"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

namespace vs {
namespace {

FrameContext FrameNumber(uint64_t number) {
  FrameContext frame;
  frame.number = number;
  frame.block_times.resize(3);
  return frame;
}

TEST(Topic, KeepsTheNewestSampleWithItsFrame) {
  Topic topic("cell/count", "integer");
  EXPECT_EQ(topic.Latest(), nullptr);
  topic.Publish(Value(int64_t{5}), FrameNumber(10), 1000);
  topic.Publish(Value(int64_t{6}), FrameNumber(12), 2000);
  const auto latest = topic.Latest();
  EXPECT_EQ(latest->seq, 2u);
  EXPECT_EQ(*latest->value.GetIf<int64_t>(), 6);
  EXPECT_EQ(latest->frame.number, 12u);
  EXPECT_EQ(latest->published_ns, 2000);
}

TEST(Topic, TellsEachListenerUntilItsHandleGoes) {
  Topic topic("cell/count", "integer");
  std::vector<uint64_t> first;
  std::vector<uint64_t> second;
  auto keep = topic.Listen([&](const auto& sample) { first.push_back(sample->seq); });
  auto drop = topic.Listen([&](const auto& sample) { second.push_back(sample->seq); });
  topic.Publish(Value(true), FrameNumber(1), 0);
  drop = nullptr;
  topic.Publish(Value(true), FrameNumber(2), 0);
  auto late = topic.Listen([&](const auto& sample) { second.push_back(sample->seq); });
  topic.Publish(Value(true), FrameNumber(3), 0);
  EXPECT_EQ(first, (std::vector<uint64_t>{1, 2, 3}));
  EXPECT_EQ(second, (std::vector<uint64_t>{1, 3}));
}

TEST(Topic, NeverCallsAListenerWhoseHandleIsGone) {
  Topic topic("cell/count", "integer");
  std::thread publisher([&topic] {
    for (uint64_t i = 1; i <= 2000; ++i) topic.Publish(Value(true), FrameNumber(i), 0);
  });
  for (int i = 0; i < 200; ++i) {
    auto alive = std::make_unique<bool>(true);
    auto handle = topic.Listen([flag = alive.get()](const auto&) { EXPECT_TRUE(*flag); });
    handle = nullptr;
    alive = nullptr;  // a late call would read freed memory
  }
  publisher.join();
  EXPECT_EQ(topic.Latest()->seq, 2000u);
}

TEST(Topic, KnowsWhetherAnybodyListens) {
  Topic topic("cell/count", "integer");
  EXPECT_FALSE(topic.HasListeners());
  auto one = topic.Listen([](const auto&) {});
  auto two = topic.Listen([](const auto&) {});
  one = nullptr;
  EXPECT_TRUE(topic.HasListeners());
  two = nullptr;
  EXPECT_FALSE(topic.HasListeners());
}

TEST(Topic, KeepsNoValueOfATap) {
  Topic tap("cell/step.sum", "integer", Topic::Kind::kTap);
  std::shared_ptr<const Sample> heard;
  const auto handle = tap.Listen([&](const auto& sample) { heard = sample; });
  tap.Publish(Value(int64_t{5}), FrameNumber(1), 0);
  EXPECT_EQ(*heard->value.GetIf<int64_t>(), 5);
  EXPECT_EQ(tap.Latest(), nullptr);
  EXPECT_EQ(heard.use_count(), 1);
}

TEST(TopicHub, FindsTapsWithoutListingThem) {
  TopicHub hub;
  auto tap = hub.OpenTap("cell/step.sum", "integer");
  EXPECT_EQ(hub.Find("cell/step.sum"), tap);
  EXPECT_TRUE(hub.All().empty());
  // A run that is started again takes the place of the one before.
  const auto next = hub.OpenTap("cell/step.sum", "integer");
  EXPECT_EQ(hub.Find("cell/step.sum"), next);
}

TEST(TopicHub, SaysWhatIsThereInstead) {
  TopicHub hub;
  EXPECT_EQ(hub.WhyAbsent("cell/depth"), "no running sequence publishes this stream (yet)");
  auto left = hub.Open("cell/left", "frame").value();
  EXPECT_EQ(hub.WhyAbsent("cell/depth"), "no running sequence publishes this stream (yet)")
      << "it is just being started";
  const auto sum = hub.OpenTap("cell/step.sum", "integer");
  const auto pass = hub.OpenTap("cell/step.pass", "bool");
  EXPECT_EQ(hub.WhyAbsent("cell/depth"),
            "sequence cell publishes left; an output of a block is cell/block.port");
  left = nullptr;
  EXPECT_EQ(hub.WhyAbsent("cell/depth"),
            "sequence cell publishes nothing; an output of a block is cell/block.port");
  EXPECT_EQ(hub.WhyAbsent("cell/other.sum"), "sequence cell has no block \"other\" with outputs");
  EXPECT_EQ(hub.WhyAbsent("cell/step.depth"),
            "the outputs of block step of sequence cell are pass, sum, without \"depth\"");
  EXPECT_EQ(hub.WhyAbsent("cell2/step.sum"), "no running sequence publishes this stream (yet)");
  EXPECT_EQ(hub.WhyAbsent("ce.ll"), "no running sequence publishes this stream (yet)");
}

TEST(TopicHub, AllowsOnePublisherForEachName) {
  TopicHub hub;
  auto depth = hub.Open("cell/depth", "depth_map");
  ASSERT_TRUE(depth.has_value());
  EXPECT_EQ(hub.Open("cell/depth", "depth_map").error().code(), StatusCode::kAlreadyExists);
  auto count = hub.Open("cell/count", "integer").value();
  ASSERT_EQ(hub.All().size(), 2u);
  EXPECT_EQ(hub.All()[0]->name(), "cell/count");
  EXPECT_EQ(hub.Find("cell/depth"), *depth);
  depth->reset();
  EXPECT_EQ(hub.Find("cell/depth"), nullptr);
  EXPECT_TRUE(hub.Open("cell/depth", "depth_map").has_value());
}

}  // namespace
}  // namespace vs
