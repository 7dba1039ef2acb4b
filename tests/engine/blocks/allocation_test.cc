// A warm sequence asks the heap for nothing.
#include <gtest/gtest.h>

#include <atomic>
#include <utility>

#include "engine/base/clock.h"
#include "engine/core/scheduler.h"
#include "engine/core/topic.h"
#include "tests/support/count_allocations.h"
#include "tests/support/wait_until.h"

namespace vs {
namespace {

std::atomic<uint64_t> frames = 0;
std::atomic<uint64_t> slabs = 0;  // that pools took, which do not use operator new

class Pictures final : public Block {
 public:
  Out<Frame> picture{this, "picture", "A picture."};
  Status Run() override {
    Frame made;
    made.image = GreyImage(pool(), 640, 480);
    made.image.Row(0)[0] = 1;
    made.camera = "made up";
    picture.Set(std::move(made));
    frame().capture_ns = environment().clock->MonotonicNs();
    return Status();
  }
};

class Brighten final : public Block {
 public:
  In<Frame> in{this, "in", "A picture."};
  Out<Frame> out{this, "out", "A brighter one."};
  Out<double> level{this, "level", "Its brightness."};
  Status Run() override {
    Frame bright = *in;
    bright.image = GreyImage(pool(), in->image.width(), in->image.height());
    bright.image.Row(0)[0] = static_cast<uint8_t>(in->image.Row(0)[0] + 1);
    level.Set(0.5);
    out.Set(std::move(bright));
    slabs += pool().SlabsMade() - std::exchange(slabs_, pool().SlabsMade());
    ++frames;
    return Status();
  }

 private:
  uint64_t slabs_ = 0;
};

VS_REGISTER_BLOCK(Pictures, {.category = "Test", .doc = "Makes pictures."});
VS_REGISTER_BLOCK(Brighten, {.category = "Test", .doc = "Brightens pictures."});

SequenceSpec Spec() {
  SequenceSpec spec;
  spec.id = "a_sequence_with_a_name_that_no_string_holds_without_the_heap";
  spec.max_frames_in_flight = 3;
  spec.blocks = {{"source", "Pictures", {}},
                 {"first", "Brighten", {}},
                 {"second", "Brighten", {}},
                 {"range", "RangeCheck", {}},
                 {"verdict", "PassFail", {}},
                 {"picture", "Publish", {{"stream", "picture"}}},
                 {"pass", "Publish", {{"stream", "pass"}}}};
  spec.connections = {{"source", "picture", "first", "in"},  {"first", "out", "second", "in"},
                      {"second", "level", "range", "value"}, {"range", "pass", "verdict", "a"},
                      {"second", "out", "picture", "value"}, {"verdict", "pass", "pass", "value"}};
  return spec;
}

// How many frames are alive at once depends on timing, so now and then a pool still grows. What
// takes memory for each frame, however, never lets a hundred frames pass without.
TEST(AWarmSequence, TakesNothingFromTheHeap) {
  const SystemClock clock;
  TopicHub topics;
  Environment environment{&clock};
  environment.topics = &topics;
  Scheduler scheduler(2, clock);
  const auto run = scheduler.Start(Sequence::Load(Spec(), 1).value(), environment).value();
  const auto topic = topics.Find(Spec().id + "/picture");
  ASSERT_NE(topic, nullptr);
  std::atomic<uint64_t> heard = 0;
  const auto handle = topic->Listen([&heard](const auto& sample) { heard = sample->seq; });
  const auto tap = topics.Find(Spec().id + "/first.out");
  ASSERT_NE(tap, nullptr);
  std::atomic<uint64_t> tapped = 0;
  const auto tapping = tap->Listen([&tapped](const auto& sample) { tapped = sample->seq; });

  EXPECT_TRUE(test::WaitUntil([&] {
    const uint64_t before = test::Allocations() + slabs;
    const uint64_t until = frames + 200;  // two blocks count
    return test::WaitUntil([&] { return frames >= until; }) &&
           test::Allocations() + slabs == before;
  }));
  EXPECT_GT(heard, 0u);
  EXPECT_GT(tapped, 0u);
  run->Stop();
}

}  // namespace
}  // namespace vs
