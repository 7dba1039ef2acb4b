#include <gtest/gtest.h>

#include <cstring>

#include "tests/support/block_harness.h"
#include "tests/support/wait_until.h"

namespace vs::test {
namespace {

bool SamePixels(const GreyImage& a, const GreyImage& b) {
  if (!a.SameSizeAs(b)) return false;
  for (int y = 0; y < a.height(); ++y) {
    if (std::memcmp(a.Row(y), b.Row(y), a.width()) != 0) return false;
  }
  return true;
}

TEST(SimulatedStereo, GivesTheSamePairsOnEveryRun) {
  BlockHarness one("SimulatedStereo");
  BlockHarness two("SimulatedStereo");
  for (BlockHarness* block : {&one, &two}) {
    ASSERT_TRUE(block->Set("rate_hz", 0.0).ok());
    ASSERT_TRUE(block->Start().ok());
  }
  for (uint64_t number = 1; number <= 3; ++number) {
    ASSERT_TRUE(one.block().Ready());
    ASSERT_TRUE(one.Run().ok());
    ASSERT_TRUE(two.Run().ok());
    const auto* pair = one.Output<StereoFrame>("pair");
    ASSERT_NE(pair, nullptr);
    EXPECT_EQ(pair->number, number);
    EXPECT_EQ(pair->left->image.width(), 648);
    EXPECT_TRUE(pair->geometry.has_value());
    ASSERT_NE(pair->truth, nullptr);
    const auto* again = two.Output<StereoFrame>("pair");
    EXPECT_TRUE(SamePixels(pair->left->image, again->left->image));
    EXPECT_TRUE(SamePixels(pair->right->image, again->right->image));
    EXPECT_GT(one.frame.capture_ns, 0);
    EXPECT_GE(one.frame.arrival_ns, one.frame.capture_ns);
  }
}

TEST(SimulatedStereo, KeepsItsRateAndCountsWhatWasMissed) {
  BlockHarness block("SimulatedStereo");
  ASSERT_TRUE(block.Set("rate_hz", 1000.0).ok());
  ASSERT_TRUE(block.Start().ok());
  ASSERT_TRUE(WaitUntil([&] { return block.block().Dropped() >= 5; }));
  ASSERT_TRUE(block.block().Ready());
  ASSERT_TRUE(block.Run().ok());
  EXPECT_GE(block.Output<StereoFrame>("pair")->number, 6u);
}

TEST(SimulatedStereo, CanBeStoppedAndStartedAgain) {
  BlockHarness block("SimulatedStereo");
  ASSERT_TRUE(block.Start().ok());
  ASSERT_TRUE(WaitUntil([&] { return block.block().Ready(); }));
  block.block().Stop();
  ASSERT_TRUE(block.Start().ok());
  ASSERT_TRUE(WaitUntil([&] { return block.block().Ready(); }));
  EXPECT_TRUE(block.Run().ok());
}

}  // namespace
}  // namespace vs::test
