#include "server/streams/subscriber.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <string>
#include <thread>
#include <vector>

#include "tests/server/streams/published.h"
#include "tests/support/fake_clock.h"
#include "tests/support/wait_until.h"

namespace vs {
namespace {

namespace pb = visionserver::v1;
using test::WaitUntil;
using ::testing::HasSubstr;

pb::Subscription Wish(uint32_t id, const std::string& stream, uint32_t window = 2) {
  pb::Subscription wanted;
  wanted.set_id(id);
  wanted.set_stream(stream);
  wanted.set_window(window);
  return wanted;
}

// What a client does, without a network.
class Client {
 public:
  Client(StreamHub& hub, const Clock& clock) : subscriber_("stream", "key", hub, clock) {
    subscriber_.OnWake([this] { ++wakes_; });
    EXPECT_EQ("stream", test::Parse(subscriber_.Next().message).stream_id());
  }

  Subscriber& subscriber() { return subscriber_; }

  Status Subscribe(const std::vector<pb::Subscription>& wanted) {
    return subscriber_.Update(wanted, {});
  }
  // The next item; waits for it. An item with a notice about the test when none comes.
  pb::StreamItem Next() {
    StreamStep step;
    const bool came = WaitUntil([&] {
      step = subscriber_.Next();
      return step.kind != StreamStep::Kind::kWait;
    });
    if (came && step.kind == StreamStep::Kind::kMessage) return test::Parse(step.message);
    pb::StreamItem none;
    none.set_notice(came ? "ended: " + step.status.message() : "nothing came");
    return none;
  }
  bool HasNothing() { return subscriber_.Next().kind == StreamStep::Kind::kWait; }
  void Ack(const pb::StreamItem& item) {
    pb::Acknowledgement ack;
    ack.set_subscription_id(item.subscription_id());
    ack.set_seq(item.seq());
    subscriber_.Ack({ack});
  }
  int wakes() const { return wakes_; }

 private:
  std::atomic<int> wakes_ = 0;
  Subscriber subscriber_;
};

class SubscriberTest : public ::testing::Test {
 protected:
  std::shared_ptr<Topic> Open(const std::string& name, const std::string& type) {
    return topics_.Open(name, type).value();
  }
  void PublishMap(Topic& topic, int seed) {
    topic.Publish(Value(std::make_shared<const DisparityMap>(test::MapOf(32, 16, seed))),
                  test::Journey(seed), 1);
  }

  test::FakeClock clock_;
  TopicHub topics_;
  StreamHub hub_{topics_, clock_};
  Client client_{hub_, clock_};
};

TEST_F(SubscriberTest, ASubscriberGetsTheNewestItemAndThenEachNewOne) {
  const auto topic = Open("demo/depth", "disparity_map");
  PublishMap(*topic, 1);
  PublishMap(*topic, 2);
  ASSERT_TRUE(client_.Subscribe({Wish(7, "demo/depth")}).ok());
  const pb::StreamItem first = client_.Next();
  EXPECT_EQ(7u, first.subscription_id());
  EXPECT_EQ(2u, first.seq());
  EXPECT_EQ(0u, first.dropped());
  EXPECT_GT(first.sent_ns(), 0);
  EXPECT_EQ(test::PixelsOf(test::MapOf(32, 16, 2).disparity), test::UnpackDisparity(first));
  EXPECT_TRUE(client_.HasNothing());
  const int wakes = client_.wakes();
  PublishMap(*topic, 3);
  EXPECT_TRUE(WaitUntil([&] { return client_.wakes() > wakes; }));
  EXPECT_EQ(3u, client_.Next().seq());
}

TEST_F(SubscriberTest, WithoutAcknowledgementItStopsAndThenGoesOnWithTheNewest) {
  const auto topic = Open("demo/depth", "disparity_map");
  ASSERT_TRUE(client_.Subscribe({Wish(1, "demo/depth", 2)}).ok());
  PublishMap(*topic, 1);
  const pb::StreamItem first = client_.Next();
  PublishMap(*topic, 2);
  (void)client_.Next();
  for (int seed = 3; seed <= 9; ++seed) PublishMap(*topic, seed);
  EXPECT_TRUE(client_.HasNothing());
  client_.Ack(first);
  const pb::StreamItem next = client_.Next();
  EXPECT_EQ(9u, next.seq());
  EXPECT_EQ(6u, next.dropped());
  EXPECT_TRUE(client_.HasNothing());
}

TEST_F(SubscriberTest, ASlowSubscriberTakesNothingFromTheOthers) {
  const auto topic = Open("demo/depth", "disparity_map");
  Client slow(hub_, clock_);
  ASSERT_TRUE(slow.Subscribe({Wish(1, "demo/depth", 1)}).ok());
  ASSERT_TRUE(client_.Subscribe({Wish(1, "demo/depth", 1)}).ok());
  for (int seed = 1; seed <= 50; ++seed) {
    PublishMap(*topic, seed);
    if (seed == 1) (void)slow.Next();
    const pb::StreamItem item = client_.Next();
    EXPECT_EQ(static_cast<uint64_t>(seed), item.seq());
    EXPECT_EQ(0u, item.dropped());
    client_.Ack(item);
  }
  EXPECT_TRUE(slow.HasNothing());
}

TEST_F(SubscriberTest, AllSubscribersOfOneEncodingShareTheBytes) {
  const auto topic = Open("demo/depth", "disparity_map");
  PublishMap(*topic, 1);
  const auto channel = hub_.Channel("demo/depth");
  const auto waker = std::make_shared<Waker>(Waker{[] {}});
  const auto take = [&](pb::Codec codec) {
    Want want;
    std::shared_ptr<const EncodedItem> item;
    EXPECT_TRUE(WaitUntil([&] {
      item = channel->Take({.codec = codec}, &want, waker);
      return item != nullptr;
    }));
    return item;
  };
  const auto first = take(pb::CODEC_RVL);
  EXPECT_EQ(first, take(pb::CODEC_RVL));
  EXPECT_NE(first, take(pb::CODEC_RAW));
  PublishMap(*topic, 2);
  EXPECT_NE(first, take(pb::CODEC_RVL));
}

TEST_F(SubscriberTest, NothingIsPackedThatNobodyWaitsFor) {
  const auto topic = Open("demo/depth", "disparity_map");
  ASSERT_TRUE(client_.Subscribe({Wish(1, "demo/depth", 1)}).ok());
  const auto map = std::make_shared<const DisparityMap>(test::MapOf(32, 16, 1));
  PublishMap(*topic, 0);
  const pb::StreamItem first = client_.Next();
  // Without credit nobody takes hold of what is published.
  topic->Publish(Value(map), test::Journey(2), 1);
  PublishMap(*topic, 3);
  EXPECT_TRUE(WaitUntil([&] { return map.use_count() == 1; }));
  client_.Ack(first);
  EXPECT_EQ(3u, client_.Next().seq());
}

TEST_F(SubscriberTest, SmallThingsGoBeforeFrames) {
  const auto depth = Open("demo/depth", "disparity_map");
  const auto verdict = Open("demo/verdict", "bool");
  PublishMap(*depth, 1);
  verdict->Publish(Value(true), test::Journey(1), 1);
  ASSERT_TRUE(client_.Subscribe({Wish(1, "demo/depth"), Wish(2, "demo/verdict")}).ok());
  EXPECT_EQ(2u, client_.Next().subscription_id());
  EXPECT_EQ(1u, client_.Next().subscription_id());
  PublishMap(*depth, 2);
  verdict->Publish(Value(false), test::Journey(2), 1);
  const pb::StreamItem second = client_.Next();
  EXPECT_EQ(2u, second.subscription_id());
  EXPECT_FALSE(second.value().bool_value());
}

TEST_F(SubscriberTest, TheRateIsLimitedAndWhatWasPassedOverIsTold) {
  const auto topic = Open("demo/count", "integer");
  pb::Subscription wanted = Wish(1, "demo/count", 16);
  wanted.set_max_fps(10);
  ASSERT_TRUE(client_.Subscribe({wanted}).ok());
  topic->Publish(Value(int64_t{1}), test::Journey(1), 1);
  EXPECT_EQ(1, client_.Next().value().int_value());
  for (int64_t n = 2; n <= 4; ++n) topic->Publish(Value(n), test::Journey(1), 1);
  const StreamStep wait = client_.subscriber().Next();
  ASSERT_EQ(StreamStep::Kind::kWait, wait.kind);
  EXPECT_EQ(clock_.MonotonicNs() + 100'000'000, wait.until_ns);
  clock_.Advance(std::chrono::milliseconds(100));
  const pb::StreamItem item = client_.Next();
  EXPECT_EQ(4, item.value().int_value());
  EXPECT_EQ(2u, item.dropped());
}

TEST_F(SubscriberTest, AStreamThatIsNotThereYetIsWaitedFor) {
  ASSERT_TRUE(client_.Subscribe({Wish(1, "demo/depth")}).ok());
  EXPECT_THAT(client_.Next().notice(), HasSubstr("no running sequence"));
  EXPECT_TRUE(client_.HasNothing());
  const int wakes = client_.wakes();
  const auto topic = Open("demo/depth", "disparity_map");
  EXPECT_TRUE(WaitUntil([&] { return client_.wakes() > wakes; }));
  PublishMap(*topic, 1);
  EXPECT_EQ(1u, client_.Next().seq());
}

TEST_F(SubscriberTest, WhenASequenceStartsAgainTheNumbersGoOn) {
  auto topic = Open("demo/depth", "disparity_map");
  ASSERT_TRUE(client_.Subscribe({Wish(1, "demo/depth", 16)}).ok());
  PublishMap(*topic, 1);
  PublishMap(*topic, 2);
  EXPECT_EQ(2u, client_.Next().seq());
  topic = nullptr;
  EXPECT_THAT(client_.Next().notice(), HasSubstr("no running sequence"));
  // Nobody is shown the last picture of what has stopped.
  Client late(hub_, clock_);
  ASSERT_TRUE(late.Subscribe({Wish(1, "demo/depth")}).ok());
  EXPECT_THAT(late.Next().notice(), HasSubstr("no running sequence"));
  topic = Open("demo/depth", "disparity_map");
  PublishMap(*topic, 3);
  const pb::StreamItem again = client_.Next();
  EXPECT_EQ(3u, again.seq());
  EXPECT_EQ(0u, again.dropped());
  EXPECT_EQ(test::PixelsOf(test::MapOf(32, 16, 3).disparity), test::UnpackDisparity(again));
}

TEST_F(SubscriberTest, AStreamMayComeBackWithAnotherType) {
  auto topic = Open("demo/out", "disparity_map");
  PublishMap(*topic, 1);
  ASSERT_TRUE(client_.Subscribe({Wish(1, "demo/out", 16)}).ok());
  EXPECT_EQ(pb::CODEC_RVL, client_.Next().header().codec());
  topic = nullptr;
  EXPECT_THAT(client_.Next().notice(), HasSubstr("no running sequence"));
  topic = Open("demo/out", "number");
  topic->Publish(Value(0.5), test::Journey(1), 1);
  EXPECT_EQ(0.5, client_.Next().value().double_value());
}

TEST_F(SubscriberTest, ACodecThatDoesNotFitIsToldAndCorrected) {
  const auto topic = Open("demo/depth", "disparity_map");
  PublishMap(*topic, 1);
  pb::Subscription wanted = Wish(1, "demo/depth");
  wanted.set_codec(pb::CODEC_JPEG);
  ASSERT_TRUE(client_.Subscribe({wanted}).ok());
  EXPECT_THAT(client_.Next().notice(), HasSubstr("not as CODEC_JPEG"));
  EXPECT_TRUE(client_.HasNothing());
  wanted.set_codec(pb::CODEC_RAW);
  ASSERT_TRUE(client_.Subscribe({wanted}).ok());
  EXPECT_EQ(pb::CODEC_RAW, client_.Next().header().codec());
}

TEST_F(SubscriberTest, ChangingASubscriptionSendsNothingTwice) {
  const auto topic = Open("demo/depth", "disparity_map");
  PublishMap(*topic, 1);
  ASSERT_TRUE(client_.Subscribe({Wish(1, "demo/depth")}).ok());
  EXPECT_EQ(1u, client_.Next().seq());
  ASSERT_TRUE(client_.Subscribe({Wish(1, "demo/depth", 5)}).ok());
  EXPECT_TRUE(client_.HasNothing());
  PublishMap(*topic, 2);
  EXPECT_EQ(2u, client_.Next().seq());
  ASSERT_TRUE(client_.subscriber().Update({}, {1}).ok());
  PublishMap(*topic, 3);
  EXPECT_TRUE(client_.HasNothing());
}

TEST_F(SubscriberTest, ChangingASubscriptionBuysNoCredit) {
  const auto topic = Open("demo/depth", "disparity_map");
  ASSERT_TRUE(client_.Subscribe({Wish(1, "demo/depth", 1)}).ok());
  PublishMap(*topic, 1);
  const pb::StreamItem first = client_.Next();
  PublishMap(*topic, 2);
  ASSERT_TRUE(client_.Subscribe({Wish(1, "demo/depth", 1)}).ok());
  EXPECT_TRUE(client_.HasNothing());
  client_.Ack(first);
  EXPECT_EQ(2u, client_.Next().seq());
}

TEST_F(SubscriberTest, WhoNeverAcknowledgesLosesTheStream) {
  const auto topic = Open("demo/count", "integer");
  topic->Publish(Value(int64_t{1}), test::Journey(1), 1);
  ASSERT_TRUE(client_.Subscribe({Wish(3, "demo/count", 1)}).ok());
  (void)client_.Next();
  clock_.Advance(std::chrono::nanoseconds(Subscriber::kAckLimitNs - 1));
  EXPECT_TRUE(client_.HasNothing());
  clock_.Advance(std::chrono::nanoseconds(1));
  const StreamStep step = client_.subscriber().Next();
  ASSERT_EQ(StreamStep::Kind::kEnd, step.kind);
  EXPECT_EQ(StatusCode::kAborted, step.status.code());
  EXPECT_THAT(step.status.message(), HasSubstr("subscription 3 (demo/count)"));
}

TEST_F(SubscriberTest, BadSubscriptionsAreAllNamedAndNothingChanges) {
  pb::Subscription wild = Wish(2, "demo/b", 17);
  pb::Subscription fast = Wish(3, "demo/c");
  fast.set_max_fps(-1);
  const Status refused =
      client_.Subscribe({Wish(1, "demo/a"), Wish(0, "demo/a"), wild, fast, Wish(4, "")});
  EXPECT_EQ(StatusCode::kInvalidArgument, refused.code());
  ASSERT_EQ(4u, refused.faults().size());
  EXPECT_EQ("subscription 0", refused.faults()[0].subject);
  std::map<std::string, uint32_t> counts;
  client_.subscriber().CountStreams(&counts);
  EXPECT_TRUE(counts.empty());

  std::vector<pb::Subscription> many;
  for (uint32_t id = 1; id <= 65; ++id) many.push_back(Wish(id, "demo/a"));
  EXPECT_EQ(StatusCode::kResourceExhausted, client_.Subscribe(many).code());
  many.pop_back();
  EXPECT_TRUE(client_.Subscribe(many).ok());
  client_.subscriber().CountStreams(&counts);
  EXPECT_EQ(64u, counts["demo/a"]);
}

TEST_F(SubscriberTest, NamesThatNobodyWaitsForAnyMoreAreForgotten) {
  const auto topic = Open("demo/depth", "disparity_map");
  {
    Client curious(hub_, clock_);
    ASSERT_TRUE(curious.Subscribe({Wish(1, "no/such"), Wish(2, "demo/depth")}).ok());
    (void)hub_.Live();
  }
  std::vector<std::shared_ptr<StreamChannel>> live = hub_.Live();
  ASSERT_EQ(1u, live.size());
  EXPECT_EQ("demo/depth", live[0]->name());
}

TEST_F(SubscriberTest, ATapIsListenedToAsLongAsSomebodyIsSubscribed) {
  auto tap = topics_.OpenTap("demo/match.disparity", "disparity_map");
  EXPECT_FALSE(tap->HasListeners());
  ASSERT_TRUE(client_.Subscribe({Wish(1, "demo/match.disparity", 16)}).ok());
  ASSERT_TRUE(tap->HasListeners());
  PublishMap(*tap, 1);
  EXPECT_EQ(test::PixelsOf(test::MapOf(32, 16, 1).disparity),
            test::UnpackDisparity(client_.Next()));
  EXPECT_TRUE(hub_.Live().empty()) << "taps are not listed";

  // The sequence is started again.
  tap = nullptr;
  EXPECT_THAT(client_.Next().notice(), HasSubstr("no running sequence"));
  tap = topics_.OpenTap("demo/match.disparity", "disparity_map");
  EXPECT_TRUE(WaitUntil([&] { return tap->HasListeners(); }));
  PublishMap(*tap, 2);
  EXPECT_EQ(2u, client_.Next().seq());

  ASSERT_TRUE(client_.subscriber().Update({}, {1}).ok());
  EXPECT_TRUE(WaitUntil([&] { return !tap->HasListeners(); }));
}

TEST_F(SubscriberTest, AWrongOutputIsToldOnceTheSequenceRuns) {
  ASSERT_TRUE(client_.Subscribe({Wish(1, "demo/match.depth")}).ok());
  EXPECT_THAT(client_.Next().notice(), HasSubstr("no running sequence"));
  const auto tap = topics_.OpenTap("demo/match.disparity", "disparity_map");
  EXPECT_EQ("the outputs of block match of sequence demo are disparity, without \"depth\"",
            client_.Next().notice());
  EXPECT_TRUE(client_.HasNothing());
}

TEST_F(SubscriberTest, ManyClientsAndOneFastSourceAgreeUnderLoad) {
  const auto topic = Open("demo/depth", "disparity_map");
  std::vector<std::thread> clients;
  std::atomic<int> reached_end = 0;
  clients.reserve(6);
  for (int i = 0; i < 6; ++i) {
    clients.emplace_back([&, i] {
      Client client(hub_, clock_);
      EXPECT_TRUE(client.Subscribe({Wish(1, "demo/depth", 1 + i % 3)}).ok());
      uint64_t last = 0;
      while (last < 300) {
        const pb::StreamItem item = client.Next();
        if (!item.notice().empty()) {
          ADD_FAILURE() << item.notice();
          return;
        }
        EXPECT_EQ(last == 0 ? 0 : item.seq() - last - 1, item.dropped());
        last = item.seq();
        EXPECT_EQ(test::PixelsOf(test::MapOf(32, 16, static_cast<int>(last)).disparity),
                  test::UnpackDisparity(item));
        client.Ack(item);
      }
      ++reached_end;
    });
  }
  for (int seed = 1; seed <= 300; ++seed) PublishMap(*topic, seed);
  for (std::thread& client : clients) client.join();
  EXPECT_EQ(6, reached_end);
}

}  // namespace
}  // namespace vs
