#include "engine/base/mailbox.h"

#include <gtest/gtest.h>

#include <thread>

namespace vs {
namespace {

TEST(Mailbox, LatestReplacesAndCountsTheLoss) {
  Mailbox<int> box;
  box.Put(1);
  box.Put(2);
  EXPECT_EQ(box.TryTake(), 2);
  EXPECT_EQ(box.TryTake(), std::nullopt);
  EXPECT_EQ(box.Dropped(), 1u);
}

TEST(Mailbox, EveryValueArrivesInOrderWhenTheProducerMayWait) {
  Mailbox<int> box(Mailbox<int>::Policy::kEvery);
  std::thread producer([&box] {
    for (int i = 0; i < 1000; ++i) box.Put(i);
  });
  for (int expected = 0; expected < 1000;) {
    if (const auto value = box.TryTake()) {
      EXPECT_EQ(*value, expected++);
    }
  }
  producer.join();
  EXPECT_EQ(box.Dropped(), 0u);
}

TEST(Mailbox, CloseFreesAWaitingProducer) {
  Mailbox<int> box(Mailbox<int>::Policy::kEvery);
  box.Put(1);
  bool second_accepted = true;
  std::thread producer([&] { second_accepted = box.Put(2); });
  box.Close();
  producer.join();
  EXPECT_FALSE(second_accepted);
  EXPECT_EQ(box.TryTake(), 1);
}

}  // namespace
}  // namespace vs
