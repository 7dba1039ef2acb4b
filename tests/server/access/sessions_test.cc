#include "server/access/sessions.h"

#include <gtest/gtest.h>

#include "tests/support/fake_clock.h"
#include "tests/support/temp_folder.h"

namespace vs {
namespace {

using std::chrono::hours;
using std::chrono::minutes;
using std::chrono::seconds;

class SessionsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    database_ = *AccessDatabase::Open(folder_ / "users.db");
    Reopen();
  }
  void Reopen() { sessions_ = *Sessions::Open(*database_, clock_, limits_); }
  Sessions::Created Create(const std::string& user) {
    return *sessions_->Create(user, "10.0.0.1", "a test");
  }
  bool Valid(const Sessions::Created& session) {
    return sessions_->Find(HashToken(session.token)).has_value();
  }

  test::TempFolder folder_;
  test::FakeClock clock_;
  SessionLimits limits_ = {.idle_ns = 1'800'000'000'000,       // 30 min
                           .lifetime_ns = 43'200'000'000'000,  // 12 h
                           .per_user = 3,
                           .total = 5};
  std::unique_ptr<AccessDatabase> database_;
  std::unique_ptr<Sessions> sessions_;
};

TEST_F(SessionsTest, KnowsItsTokensAndNoOthers) {
  const Sessions::Created session = Create("maria");
  EXPECT_EQ(sessions_->Find(HashToken(session.token))->user, "maria");
  EXPECT_FALSE(sessions_->Find(HashToken(session.token + "x")).has_value());
  EXPECT_FALSE(sessions_->Find(HashToken("")).has_value());
}

TEST_F(SessionsTest, EndsWhenNotUsed) {
  const Sessions::Created session = Create("maria");
  clock_.Advance(minutes(29));
  EXPECT_TRUE(Valid(session));  // which uses it
  clock_.Advance(minutes(29));
  EXPECT_TRUE(Valid(session));
  clock_.Advance(minutes(30));
  EXPECT_FALSE(Valid(session));
}

TEST_F(SessionsTest, EndsAfterItsLifeHoweverMuchItIsUsed) {
  const Sessions::Created session = Create("maria");
  for (int i = 0; i < 35; ++i) {
    clock_.Advance(minutes(20));
    EXPECT_TRUE(Valid(session)) << i;
  }
  clock_.Advance(minutes(20));
  EXPECT_FALSE(Valid(session));
}

TEST_F(SessionsTest, IsNotLengthenedBySettingTheWallClock) {
  const Sessions::Created session = Create("maria");
  clock_.SetUtcBack(hours(24 * 10));
  clock_.Advance(minutes(31));
  EXPECT_FALSE(Valid(session));
}

TEST_F(SessionsTest, SurvivesARestart) {
  const Sessions::Created session = Create("maria");
  Reopen();
  EXPECT_TRUE(Valid(session));
}

TEST_F(SessionsTest, DoesNotSurviveItsEndByARestart) {
  const Sessions::Created session = Create("maria");
  clock_.Advance(hours(12));
  Reopen();
  EXPECT_FALSE(Valid(session));
  EXPECT_TRUE(database_->Sessions()->empty());
}

TEST_F(SessionsTest, DoesNotComeBackToLifeByARestart) {
  const Sessions::Created session = Create("maria");
  clock_.Advance(minutes(31));
  Reopen();
  EXPECT_FALSE(Valid(session));
  EXPECT_TRUE(database_->Sessions()->empty());
}

TEST_F(SessionsTest, TimeWithoutUseGoesOnOverARestart) {
  const Sessions::Created session = Create("maria");
  clock_.Advance(minutes(20));
  Reopen();
  EXPECT_FALSE(sessions_->List("maria").empty());
  clock_.Advance(minutes(10));
  EXPECT_FALSE(Valid(session));
}

TEST_F(SessionsTest, KnowsItsLastUseAfterACrash) {
  const Sessions::Created session = Create("maria");
  clock_.Advance(minutes(20));
  EXPECT_TRUE(Valid(session));
  ASSERT_TRUE(sessions_->StoreLastUse().ok());
  clock_.Advance(minutes(20));
  const auto after_crash = *Sessions::Open(*database_, clock_, limits_);
  EXPECT_TRUE(after_crash->Find(HashToken(session.token)).has_value());
}

TEST_F(SessionsTest, NeverLivesLongerThanALifeAfterARestartWithAWrongClock) {
  const Sessions::Created session = Create("maria");
  clock_.SetUtcBack(hours(24 * 365));
  Reopen();
  for (int i = 0; i < 35; ++i) {
    clock_.Advance(minutes(20));
    EXPECT_TRUE(Valid(session)) << i;
  }
  clock_.Advance(minutes(20));
  EXPECT_FALSE(Valid(session));
}

TEST_F(SessionsTest, RemovedOneIsGoneForGood) {
  const Sessions::Created session = Create("maria");
  EXPECT_EQ(sessions_->Remove(session.record.id, "ben").code(), StatusCode::kNotFound);
  EXPECT_TRUE(Valid(session));
  EXPECT_TRUE(sessions_->Remove(session.record.id, "maria").ok());
  EXPECT_FALSE(Valid(session));
  EXPECT_EQ(sessions_->Remove(session.record.id, "maria").code(), StatusCode::kNotFound);
  Reopen();
  EXPECT_FALSE(Valid(session));
}

TEST_F(SessionsTest, RemovesAllOfAUserButOne) {
  const Sessions::Created first = Create("maria");
  const Sessions::Created second = Create("maria");
  const Sessions::Created other = Create("ben");
  EXPECT_TRUE(sessions_->RemoveOf("maria", second.record.id).ok());
  EXPECT_FALSE(Valid(first));
  EXPECT_TRUE(Valid(second));
  EXPECT_TRUE(Valid(other));
}

TEST_F(SessionsTest, OneTooManyEndsTheOneUnusedForLongest) {
  const Sessions::Created first = Create("maria");
  clock_.Advance(seconds(1));
  const Sessions::Created second = Create("maria");
  clock_.Advance(seconds(1));
  const Sessions::Created third = Create("maria");
  clock_.Advance(seconds(1));
  EXPECT_TRUE(Valid(first));
  clock_.Advance(seconds(1));
  const Sessions::Created fourth = Create("maria");
  EXPECT_TRUE(Valid(first));
  EXPECT_FALSE(Valid(second));
  EXPECT_TRUE(Valid(third));
  EXPECT_TRUE(Valid(fourth));
}

TEST_F(SessionsTest, RefusesMoreThanTheServerTakes) {
  for (const char* user : {"a", "b", "c", "d", "e"}) Create(user);
  const auto sixth = sessions_->Create("f", "10.0.0.1", "");
  ASSERT_FALSE(sixth.has_value());
  EXPECT_EQ(sixth.error().code(), StatusCode::kResourceExhausted);
  clock_.Advance(minutes(31));
  EXPECT_TRUE(sessions_->Create("f", "10.0.0.1", "").has_value());
}

TEST_F(SessionsTest, WhatEndedIsGoneFromTheDiskEvenWhenTheServerIsFull) {
  const Sessions::Created unused = Create("a");
  clock_.Advance(minutes(20));
  for (const char* user : {"b", "c", "d", "e"}) Create(user);
  limits_.total = 4;
  Reopen();
  clock_.Advance(minutes(11));
  EXPECT_FALSE(sessions_->Create("f", "10.0.0.1", "").has_value());
  EXPECT_EQ(database_->Sessions()->size(), 4U);
}

TEST_F(SessionsTest, ListsTheNewestFirstWithTheLastUse) {
  Create("maria");
  clock_.Advance(minutes(5));
  Create("ben");
  Create("maria");
  const std::vector<SessionInfo> all = sessions_->List("");
  ASSERT_EQ(all.size(), 3U);
  const std::vector<SessionInfo> marias = sessions_->List("maria");
  ASSERT_EQ(marias.size(), 2U);
  EXPECT_EQ(marias[0].record.created_utc_ns - marias[1].record.created_utc_ns, 300'000'000'000);
  EXPECT_EQ(marias[1].last_used_utc_ns, marias[1].record.created_utc_ns);
  EXPECT_EQ(marias[0].record.client, "a test");
}

}  // namespace
}  // namespace vs
