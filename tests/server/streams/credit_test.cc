#include "server/streams/credit.h"

#include <gtest/gtest.h>

namespace vs {
namespace {

constexpr int64_t kMs = 1'000'000;

TEST(Credit, EndsAtTheWindowUntilItemsAreAcknowledged) {
  Credit credit(2, 0);
  EXPECT_TRUE(credit.Allows(0));
  credit.OnSent(10, 0);
  EXPECT_TRUE(credit.Allows(0));
  credit.OnSent(12, 5);
  EXPECT_FALSE(credit.Allows(1000 * kMs));
  EXPECT_EQ(std::nullopt, credit.AllowedFrom());
  credit.OnAck(10);
  EXPECT_TRUE(credit.Allows(5));
  credit.OnSent(13, 6);
  EXPECT_FALSE(credit.Allows(6));
}

TEST(Credit, AnAcknowledgementCountsForAllEarlierItems) {
  Credit credit(3, 0);
  credit.OnSent(1, 0);
  credit.OnSent(4, 1);
  credit.OnSent(9, 2);
  credit.OnAck(4);
  EXPECT_EQ(2, credit.UnacknowledgedSince());
  credit.OnAck(4);
  EXPECT_EQ(2, credit.UnacknowledgedSince());
  credit.OnAck(9);
  EXPECT_EQ(std::nullopt, credit.UnacknowledgedSince());
}

TEST(Credit, AcknowledgingWhatWasNeverSentBuysNothing) {
  Credit credit(1, 0);
  credit.OnAck(5);
  credit.OnSent(1, 0);
  credit.OnAck(1000);
  EXPECT_FALSE(credit.Allows(0));
  credit.OnAck(0);
  EXPECT_FALSE(credit.Allows(0));
}

TEST(Credit, GoesOnWhereAnotherOneWas) {
  Credit slow(2, 1);  // every 1000 ms
  slow.OnSent(1, 5000 * kMs);
  slow.OnSent(2, 6000 * kMs);
  Credit quick(2, 10);
  quick.Continue(slow);
  EXPECT_EQ(5000 * kMs, quick.UnacknowledgedSince());
  EXPECT_FALSE(quick.Allows(9000 * kMs)) << "both are still under way";
  quick.OnAck(1);
  EXPECT_FALSE(quick.Allows(6099 * kMs));
  EXPECT_TRUE(quick.Allows(6100 * kMs)) << "100 ms after the last one";
  Credit fresh(2, 1);
  fresh.Continue(Credit(2, 10));
  EXPECT_TRUE(fresh.Allows(0));
}

TEST(Credit, TheRateIsKeptAlsoWhenItemsComeLate) {
  Credit credit(16, 10);  // every 100 ms
  credit.OnSent(1, 1000 * kMs);
  EXPECT_FALSE(credit.Allows(1099 * kMs));
  EXPECT_EQ(1100 * kMs, credit.AllowedFrom());
  EXPECT_TRUE(credit.Allows(1100 * kMs));
  credit.OnSent(2, 1130 * kMs);
  EXPECT_TRUE(credit.Allows(1200 * kMs));
  credit.OnSent(3, 1200 * kMs);
  // A pause is not made up for.
  credit.OnSent(4, 5000 * kMs);
  EXPECT_FALSE(credit.Allows(5050 * kMs));
  EXPECT_TRUE(credit.Allows(5100 * kMs));
}

}  // namespace
}  // namespace vs
