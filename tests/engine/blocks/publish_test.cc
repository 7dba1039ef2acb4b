#include <gtest/gtest.h>

#include <string>

#include "engine/core/topic.h"
#include "tests/support/block_harness.h"

namespace vs {
namespace {

using test::BlockHarness;

class Publish : public ::testing::Test {
 protected:
  Publish() {
    block_.environment.topics = &topics_;
    block_.Input("value", int64_t{7});
    EXPECT_TRUE(block_.Set("stream", std::string("count")).ok());
  }

  TopicHub topics_;
  BlockHarness block_{"Publish"};
};

TEST_F(Publish, OffersItsInputUnderTheSequencesName) {
  ASSERT_TRUE(block_.Start().ok());
  const auto topic = topics_.Find("test_sequence/count");
  ASSERT_NE(topic, nullptr);
  EXPECT_EQ(topic->type(), "integer");
  ASSERT_TRUE(block_.Run().ok());
  ASSERT_TRUE(block_.Run().ok());
  const auto sample = topic->Latest();
  EXPECT_EQ(*sample->value.GetIf<int64_t>(), 7);
  EXPECT_EQ(sample->seq, 2u);
  EXPECT_EQ(sample->frame.number, 2u);
  EXPECT_GT(sample->published_ns, 0);
}

TEST_F(Publish, TakesItsStreamAwayWhenItStops) {
  ASSERT_TRUE(block_.Start().ok());
  block_.block().Stop();
  EXPECT_EQ(topics_.Find("test_sequence/count"), nullptr);
}

TEST_F(Publish, RefusesANameThatIsTakenOrUnusable) {
  const auto other = topics_.Open("test_sequence/count", "integer").value();
  EXPECT_EQ(block_.Start().code(), StatusCode::kAlreadyExists);
  EXPECT_EQ(block_.Set("stream", std::string("../other")),
            InvalidArgument("stream: must be a-z, 0-9 and _, begin with a letter and have at most "
                            "63 characters, not \"../other\""));
}

}  // namespace
}  // namespace vs
