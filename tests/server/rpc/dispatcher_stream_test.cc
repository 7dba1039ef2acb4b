// Streams: how they open, send, wait and end.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/server/rpc/dispatcher_fixture.h"

namespace vs::test {
namespace {

using std::chrono::milliseconds;
using ::testing::HasSubstr;

TEST_F(DispatcherTest, StreamSendsTheNewestOnceTheLastIsOut) {
  FakeChannel channel;
  const auto call = Open(channel);
  service_.numbers.Publish(1);
  ASSERT_TRUE(WaitUntil([&] { return channel.messages().size() == 1; }));
  // The client is slow: what comes meanwhile replaces each other.
  for (int i = 2; i <= 50; ++i) service_.numbers.Publish(i);
  EXPECT_EQ(channel.messages().size(), 1U);
  call->OnSent(true);
  ASSERT_TRUE(WaitUntil([&] { return channel.messages().size() == 2; }));
  EXPECT_EQ(channel.messages()[1], "50");
  call->OnSent(true);
  service_.numbers.Publish(-1);
  EXPECT_EQ(channel.status(), DataLoss("no more"));
  EXPECT_EQ(dispatcher_->OpenStreams(), 0U);
}

TEST_F(DispatcherTest, StreamThatCannotOpenSaysWhy) {
  FakeChannel channel;
  Begin(kWatch, channel)->OnRequest(WatchBytes("nothing"));
  EXPECT_EQ(channel.status(), NotFound("nothing there"));
}

TEST_F(DispatcherTest, ExceptionOfASourceEndsItsStream) {
  FakeChannel channel;
  const auto call = Open(channel);
  service_.numbers.Publish(-2);
  EXPECT_EQ(channel.status().code(), StatusCode::kInternal);
  EXPECT_TRUE(WaitUntil([&] { return service_.numbers.sources == 0; }));
}

TEST_F(DispatcherTest, SourceIsAskedAgainAtTheInstantItNamed) {
  FakeChannel channel;
  const auto call = Open(channel, "clock");
  for (size_t i = 1; i <= 5; ++i) {
    ASSERT_TRUE(WaitUntil([&] { return channel.messages().size() == i; }));
    call->OnSent(true);
  }
  EXPECT_TRUE(channel.status().ok());
  EXPECT_EQ(channel.messages().size(), 5U);
}

TEST_F(DispatcherTest, ClientThatLeavesFreesItsSource) {
  FakeChannel resting;
  const auto idle = Open(resting);
  idle->OnCancelled();
  EXPECT_EQ(resting.status().code(), StatusCode::kCancelled);
  EXPECT_TRUE(WaitUntil([&] { return service_.numbers.sources == 0; }));

  FakeChannel sending;
  const auto busy = Open(sending);
  service_.numbers.Publish(1);
  ASSERT_TRUE(WaitUntil([&] { return sending.messages().size() == 1; }));
  busy->OnCancelled();
  busy->OnSent(false);
  EXPECT_EQ(sending.status().code(), StatusCode::kCancelled);
  EXPECT_TRUE(WaitUntil([&] { return service_.numbers.sources == 0; }));
}

TEST_F(DispatcherTest, WakeAfterTheEndDoesNothing) {
  FakeChannel channel;
  {
    const auto call = Open(channel);
    call->OnCancelled();
    EXPECT_TRUE(channel.Ended());
  }
  service_.numbers.Publish(7);
  EXPECT_TRUE(channel.messages().empty());
}

TEST_F(DispatcherTest, UnaryCallMayWaitForASource) {
  FakeChannel channel;
  const auto call = Begin(kCheck, channel);
  call->OnRequest("");
  ASSERT_TRUE(WaitUntil([&] { return service_.numbers.sources == 1; }));
  service_.numbers.Publish(7);
  EXPECT_TRUE(channel.status().ok());
  EXPECT_EQ(channel.messages(), std::vector<std::string>{"7"});
}

TEST_F(DispatcherTest, ClientStreamIsAnsweredRequestByRequest) {
  FakeChannel channel;
  const auto call = Begin(kExchange, channel);
  for (int i = 1; i <= 3; ++i) {
    ASSERT_EQ(channel.receives, i);
    reflection::ServerReflectionRequest request;
    request.set_host(std::to_string(i));
    call->OnRequest(request.SerializeAsString());
    ASSERT_TRUE(WaitUntil([&] { return channel.messages().size() == static_cast<size_t>(i); }));
    call->OnSent(true);
  }
  call->OnRequest(std::nullopt);
  EXPECT_TRUE(channel.status().ok());
}

TEST_F(DispatcherTest, RevokedSessionEndsItsStreams) {
  FakeChannel idle;
  const auto first = Open(idle);
  gate_.valid = false;
  EXPECT_EQ(idle.status(), Unauthenticated("session has ended"));
}

TEST_F(DispatcherTest, RevokedSessionEndsAStreamThatNobodyReads) {
  FakeChannel channel;
  const auto call = Open(channel);
  service_.numbers.Publish(1);
  ASSERT_TRUE(WaitUntil([&] { return channel.messages().size() == 1; }));
  gate_.valid = false;
  ASSERT_TRUE(WaitUntil([&] { return channel.aborts > 0; }));
  call->OnSent(false);
  EXPECT_EQ(channel.status(), Unauthenticated("session has ended"));
}

TEST_F(DispatcherTest, StreamThatNobodyReadsIsCutOff) {
  Start({.unread = {.silence = milliseconds(5)}});
  FakeChannel channel;
  const auto call = Open(channel);
  service_.numbers.Publish(1);
  ASSERT_TRUE(WaitUntil([&] { return channel.aborts > 0; }));
  call->OnSent(false);
  EXPECT_EQ(channel.status().code(), StatusCode::kCancelled);
  EXPECT_TRUE(WaitUntil([&] { return service_.numbers.sources == 0; }));
}

TEST_F(DispatcherTest, AnswerThatNobodyReadsIsCutOff) {
  Start({.unread = {.silence = milliseconds(5)}});
  FakeChannel channel;
  const auto call = Begin(kLogin, channel);
  call->OnRequest(LoginBytes("maria"));
  EXPECT_TRUE(channel.status().ok());
  EXPECT_TRUE(WaitUntil([&] { return channel.aborts == 1; }));
  call->OnDone();
}

TEST_F(DispatcherTest, ThereIsMoreTimeForWhatIsLarge) {
  Start({.unread = {.silence = milliseconds(5), .least_bytes_per_s = 1}});
  FakeChannel large;
  const auto slow = Begin(kExchange, large);
  reflection::ServerReflectionRequest request;
  request.set_host(std::string(10'000, 'x'));
  slow->OnRequest(request.SerializeAsString());
  ASSERT_TRUE(WaitUntil([&] { return large.messages().size() == 1; }));
  FakeChannel empty;
  const auto quick = Begin(kWhoAmI, empty);
  quick->OnRequest("");
  EXPECT_TRUE(WaitUntil([&] { return empty.aborts == 1; }));
  EXPECT_EQ(large.aborts, 0);
  quick->OnDone();
  slow->OnSent(true);
  slow->OnRequest(std::nullopt);
}

TEST_F(DispatcherTest, ReadingAStreamCountsAsUseOfTheSession) {
  FakeChannel channel;
  const auto call = Open(channel);
  EXPECT_EQ(gate_.uses, 0);
  service_.numbers.Publish(1);
  ASSERT_TRUE(WaitUntil([&] { return channel.messages().size() == 1; }));
  call->OnSent(true);
  EXPECT_TRUE(WaitUntil([&] { return gate_.uses == 1; }));
  call->OnCancelled();
}

TEST_F(DispatcherTest, RefusesMoreStreamsThanItTakes) {
  Start({.max_open_streams = 2});
  FakeChannel first;
  FakeChannel second;
  FakeChannel third;
  const auto one = Open(first);
  const auto two = Open(second);
  Begin(kWatch, third)->OnRequest("");
  EXPECT_EQ(third.status().code(), StatusCode::kResourceExhausted);
  one->OnCancelled();
  EXPECT_TRUE(first.Ended());
  FakeChannel fourth;
  const auto four = Open(fourth);
  two->OnCancelled();
  four->OnCancelled();
  EXPECT_TRUE(second.Ended());
  EXPECT_TRUE(fourth.Ended());
}

TEST_F(DispatcherTest, OneSessionDoesNotTakeTheStreamsOfAll) {
  Start({.max_open_streams = 3, .max_streams_per_session = 1});
  FakeChannel first;
  FakeChannel second;
  FakeChannel other;
  const auto one = Open(first);
  Begin(kWatch, second)->OnRequest("");
  EXPECT_EQ(second.status().code(), StatusCode::kResourceExhausted);
  EXPECT_THAT(second.status().message(), HasSubstr("this login"));
  const auto bens = Begin(kWatch, other, "good ben");
  bens->OnRequest("");
  EXPECT_TRUE(WaitUntil([&] { return dispatcher_->OpenStreams() == 2; }));
  one->OnCancelled();
  bens->OnCancelled();
  EXPECT_TRUE(first.Ended());
  EXPECT_TRUE(other.Ended());
}

}  // namespace
}  // namespace vs::test
