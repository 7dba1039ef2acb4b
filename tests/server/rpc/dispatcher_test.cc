// Unary calls, draining and counting.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/server/rpc/dispatcher_fixture.h"

namespace vs::test {
namespace {

using ::testing::HasSubstr;

TEST_F(DispatcherTest, AnswersAUnaryCall) {
  FakeChannel channel;
  const auto call = Begin(kLogin, channel);
  EXPECT_EQ(channel.receives, 1);
  call->OnRequest(LoginBytes("maria"));
  EXPECT_TRUE(channel.status().ok());
  pb::LoginResponse response;
  ASSERT_EQ(channel.messages().size(), 1U);
  ASSERT_TRUE(response.ParseFromString(channel.messages()[0]));
  EXPECT_EQ(response.token(), "maria");
}

TEST_F(DispatcherTest, LooksAtNoRequestOfAStranger) {
  FakeChannel channel;
  Begin(kLogin, channel, "bad");
  EXPECT_EQ(channel.status().code(), StatusCode::kUnauthenticated);
  EXPECT_EQ(channel.receives, 0);
}

TEST_F(DispatcherTest, KnowsWhatItDoesNotHave) {
  FakeChannel channel;
  Begin("/visionserver.v1.SessionService/Nothing", channel);
  EXPECT_EQ(channel.status().code(), StatusCode::kUnimplemented);
}

TEST_F(DispatcherTest, RefusesBadRequestsBeforeTheHandler) {
  FakeChannel empty;
  Begin(kLogin, empty)->OnRequest(std::nullopt);
  EXPECT_EQ(empty.status().code(), StatusCode::kInvalidArgument);
  FakeChannel garbage;
  Begin(kLogin, garbage)->OnRequest("\x0a\x7f");
  EXPECT_EQ(garbage.status().code(), StatusCode::kInvalidArgument);
  FakeChannel large;
  Begin(kLogin, large)->OnRequest(std::string(101, ' '));
  EXPECT_EQ(large.status().code(), StatusCode::kResourceExhausted);
  FakeChannel turned_away;
  Begin(kLogout, turned_away)->OnRequest("");
  EXPECT_EQ(turned_away.status(), ResourceExhausted("too often"));
}

TEST_F(DispatcherTest, ExceptionEndsTheCallOnlyAndTellsNoSecrets) {
  FakeChannel channel;
  Begin(kLogin, channel)->OnRequest(LoginBytes("throw"));
  EXPECT_EQ(channel.status().code(), StatusCode::kInternal);
  EXPECT_THAT(channel.status().message(), HasSubstr("incident"));
  EXPECT_THAT(channel.status().message(), ::testing::Not(HasSubstr("secret")));
  FakeChannel memory;
  Begin(kLogin, memory)->OnRequest(LoginBytes("no memory"));
  EXPECT_EQ(memory.status().code(), StatusCode::kResourceExhausted);
}

TEST_F(DispatcherTest, FullLaneTurnsCallsAway) {
  Start({.quick_threads = 1, .quick_queue = 1});
  FakeChannel working;
  Begin(kLogin, working)->OnRequest(LoginBytes("wait"));
  service_.waiting.wait();
  FakeChannel queued;
  Begin(kLogin, queued)->OnRequest(LoginBytes("maria"));
  FakeChannel surplus;
  Begin(kLogin, surplus)->OnRequest(LoginBytes("maria"));
  EXPECT_EQ(surplus.status().reason(), "OVERLOADED");
  // What does not need the lane is not held up.
  FakeChannel other;
  Begin(kWhoAmI, other)->OnRequest("");
  EXPECT_TRUE(other.status().ok());
  service_.go_on.count_down();
  EXPECT_TRUE(working.status().ok());
  EXPECT_TRUE(queued.status().ok());
}

TEST_F(DispatcherTest, ASlowQueryHoldsUpOnlyThoseOfItsOwnLogin) {
  FakeChannel slow;
  Begin(kQuery, slow, "good anna")->OnRequest(QueryBytes("wait"));
  service_.waiting.wait();
  FakeChannel own;
  Begin(kQuery, own, "good anna")->OnRequest(QueryBytes("quick"));
  for (const char* other : {"good ben", "good cleo"}) {
    FakeChannel channel;
    Begin(kQuery, channel, other)->OnRequest(QueryBytes("quick"));
    EXPECT_TRUE(channel.status().ok());
  }
  EXPECT_FALSE(own.finished);
  service_.go_on.count_down();
  EXPECT_TRUE(slow.status().ok());
  EXPECT_TRUE(own.status().ok());
}

TEST_F(DispatcherTest, OneLoginDoesNotFillTheQueueOfQueries) {
  Start({.queries = {.max_waiting = 2, .max_waiting_each = 1}});
  FakeChannel slow;
  Begin(kQuery, slow, "good anna")->OnRequest(QueryBytes("wait"));
  service_.waiting.wait();
  FakeChannel own;
  Begin(kQuery, own, "good anna")->OnRequest(QueryBytes("quick"));
  FakeChannel surplus;
  Begin(kQuery, surplus, "good anna")->OnRequest(QueryBytes("quick"));
  EXPECT_EQ(surplus.status().code(), StatusCode::kResourceExhausted);
  EXPECT_EQ(surplus.status().reason(), "OVERLOADED");
  EXPECT_THAT(surplus.status().message(), HasSubstr("this login has 1 calls"));
  FakeChannel other;
  Begin(kQuery, other, "good ben")->OnRequest(QueryBytes("quick"));
  EXPECT_TRUE(other.status().ok());
  service_.go_on.count_down();
}

TEST_F(DispatcherTest, HandlerLearnsThatTheClientHasGone) {
  FakeChannel channel;
  const auto call = Begin(kLogin, channel);
  call->OnRequest(LoginBytes("wait"));
  service_.waiting.wait();
  call->OnCancelled();
  service_.go_on.count_down();
  EXPECT_TRUE(channel.Ended());
  EXPECT_TRUE(service_.was_cancelled);
}

TEST_F(DispatcherTest, DoesNotBeginWorkThatNobodyWaitsFor) {
  Start({.quick_threads = 1});
  FakeChannel working;
  Begin(kLogin, working)->OnRequest(LoginBytes("wait"));
  service_.waiting.wait();
  FakeChannel channel;
  const auto call = Begin(kLogin, channel);
  call->OnRequest(LoginBytes("maria"));
  call->OnCancelled();
  service_.go_on.count_down();
  EXPECT_EQ(channel.status().code(), StatusCode::kCancelled);
}

TEST_F(DispatcherTest, DrainEndsStreamsAndRefusesCalls) {
  FakeChannel stream;
  const auto open = Open(stream);
  FakeChannel working;
  Begin(kLogin, working)->OnRequest(LoginBytes("wait"));
  service_.waiting.wait();
  dispatcher_->Drain();
  EXPECT_EQ(stream.status().code(), StatusCode::kUnavailable);
  FakeChannel late;
  Begin(kLogin, late);
  EXPECT_EQ(late.status().code(), StatusCode::kUnavailable);
  // What runs comes to its end.
  EXPECT_FALSE(dispatcher_->Idle());
  service_.go_on.count_down();
  EXPECT_TRUE(working.status().ok());
}

TEST_F(DispatcherTest, DrainStopsWhatWorksAndWhatQueues) {
  Start({.quick_threads = 1});
  FakeChannel working;
  Begin(kLogin, working)->OnRequest(LoginBytes("until cancelled"));
  service_.waiting.wait();
  FakeChannel queued;
  Begin(kLogin, queued)->OnRequest(LoginBytes("maria"));
  dispatcher_->Drain();
  // Neither failed by itself.
  EXPECT_EQ(working.status(), Unavailable("the server is shutting down"));
  EXPECT_EQ(queued.status(), Unavailable("the server is shutting down"));
  EXPECT_TRUE(WaitUntil([&] { return dispatcher_->Idle(); }));
}

TEST_F(DispatcherTest, CountsCallsByMethod) {
  FakeChannel good;
  Begin(kLogin, good)->OnRequest(LoginBytes("maria"));
  EXPECT_TRUE(good.Ended());
  FakeChannel denied;
  Begin(kLogin, denied, "bad");
  FakeChannel left;
  Open(left)->OnCancelled();
  EXPECT_TRUE(left.Ended());
  const std::vector<MethodStats> stats = dispatcher_->Statistics();
  ASSERT_EQ(stats.size(), 2U);
  EXPECT_EQ(stats[0].method, kWatch);
  EXPECT_EQ(stats[0].succeeded, 1U);
  EXPECT_EQ(stats[1].method, kLogin);
  EXPECT_EQ(stats[1].succeeded, 1U);
  EXPECT_EQ(stats[1].failed, 1U);
  EXPECT_GT(stats[1].mean_us, 0);
}

}  // namespace
}  // namespace vs::test
