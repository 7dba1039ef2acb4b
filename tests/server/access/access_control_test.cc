#include "server/access/access_control.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/fake_clock.h"
#include "tests/support/temp_folder.h"

namespace vs {
namespace {

using std::chrono::milliseconds;
using std::chrono::minutes;

constexpr const char* kPassword = "correct horse battery";
constexpr const char* kList = "/visionserver.v1.SequenceService/ListSequences";
constexpr const char* kStart = "/visionserver.v1.SequenceService/StartSequence";

class AccessControlTest : public ::testing::Test {
 protected:
  void SetUp() override {
    access_ = *AccessControl::Open(
        {.database = folder_ / "users.db", .password_cost = {.passes = 1, .memory_bytes = 8192}},
        clock_);
    AddUser("root", Role::kAdmin);
    AddUser("maria", Role::kOperator);
  }
  void AddUser(const std::string& name, Role role) {
    const std::string one_time = *access_->accounts().CreateUser({.name = name, .role = role});
    ASSERT_TRUE(access_->accounts().ChangePassword(name, one_time, kPassword).ok());
  }
  Result<AccessControl::LoggedIn> LogIn(const std::string& name, const std::string& password,
                                        const std::string& address = "10.0.0.1") {
    return access_->LogIn(name, password, address, "a test");
  }

  test::TempFolder folder_;
  test::FakeClock clock_;
  std::unique_ptr<AccessControl> access_;
};

TEST_F(AccessControlTest, LetsInWhoLoggedIn) {
  const AccessControl::LoggedIn login = *LogIn("maria", kPassword);
  const Result<Caller> caller = access_->Admit(kStart, login.token);
  ASSERT_TRUE(caller.has_value());
  EXPECT_EQ(caller->name, "maria");
  EXPECT_EQ(caller->role, Role::kOperator);
  EXPECT_EQ(caller->credential_id, login.session.id);
}

TEST_F(AccessControlTest, GivesTheSameAnswerForAnUnknownUserAndAWrongPassword) {
  const uint64_t before = access_->hasher().Computed();
  const Status wrong = LogIn("maria", "a wrong one!").error();
  const uint64_t work_wrong = access_->hasher().Computed() - before;
  const Status unknown = LogIn("nobody", "a wrong one!").error();
  const uint64_t work_unknown = access_->hasher().Computed() - before - work_wrong;
  EXPECT_EQ(wrong.code(), StatusCode::kUnauthenticated);
  EXPECT_EQ(wrong, unknown);
  EXPECT_EQ(work_wrong, 1U);
  EXPECT_EQ(work_unknown, 1U);
}

TEST_F(AccessControlTest, SlowsGuessingDownAndLetsTheOwnerInAfterwards) {
  const uint64_t before = access_->hasher().Computed();
  for (int i = 0; i < 1000; ++i) {
    EXPECT_FALSE(LogIn("maria", "a wrong one!").has_value());
    clock_.Advance(milliseconds(60));
  }
  EXPECT_LE(access_->hasher().Computed() - before, 25U);
  EXPECT_EQ(LogIn("maria", kPassword).error().code(), StatusCode::kResourceExhausted);
  EXPECT_TRUE(LogIn("root", kPassword, "10.0.0.2").has_value());
  clock_.Advance(minutes(15));
  EXPECT_TRUE(LogIn("maria", kPassword).has_value());
}

TEST_F(AccessControlTest, TurnsAnAddressAwayBeforeItsLoginIsQueued) {
  for (int i = 0; i < 20; ++i) (void)LogIn("nobody" + std::to_string(i), "a wrong one!");
  EXPECT_EQ(access_->AdmitLogin("10.0.0.1").code(), StatusCode::kResourceExhausted);
  EXPECT_TRUE(access_->AdmitLogin("10.0.0.2").ok());
}

TEST_F(AccessControlTest, AcceptsNoneOfTenThousandMutatedTokens) {
  const std::string token = LogIn("maria", kPassword)->token;
  const std::string key = access_->accounts().CreateApiKey({.name = "cell 7"})->secret;
  std::mt19937 random(7);
  int accepted = 0;
  for (int i = 0; i < 10'000; ++i) {
    std::string mutated = i % 2 == 0 ? token : key;
    switch (i % 5) {
      case 0:
        mutated[random() % mutated.size()] ^= static_cast<char>(1 + random() % 255);
        break;
      case 1:
        mutated.resize(random() % mutated.size());
        break;
      case 2:
        mutated += static_cast<char>(random());
        break;
      case 3:
        std::swap(mutated[4], mutated[5 + random() % (mutated.size() - 5)]);
        mutated[6] = mutated[6] == 'a' ? 'b' : 'a';
        break;
      default:
        mutated = std::string(random() % 4000, 'A');
    }
    if (mutated == token || mutated == key) continue;
    if (access_->Admit(kList, mutated).has_value()) ++accepted;
  }
  EXPECT_EQ(accepted, 0);
  EXPECT_TRUE(access_->Admit(kList, token).has_value());
  EXPECT_TRUE(access_->Admit(kList, key).has_value());
}

TEST_F(AccessControlTest, ExpiredTokenIsWorthNothing) {
  const std::string token = LogIn("maria", kPassword)->token;
  clock_.Advance(minutes(30));
  EXPECT_EQ(access_->Admit(kList, token).error().code(), StatusCode::kUnauthenticated);
}

TEST_F(AccessControlTest, OneTimePasswordLeadsOnlyToItsChange) {
  const std::string one_time = *access_->accounts().ResetPassword("maria");
  const AccessControl::LoggedIn login = *LogIn("maria", one_time);
  EXPECT_EQ(access_->Admit(kList, login.token).error().reason(), "PASSWORD_CHANGE_REQUIRED");
  const Caller caller =
      *access_->Admit("/visionserver.v1.SessionService/ChangePassword", login.token);
  ASSERT_TRUE(access_->ChangePassword(caller, one_time, "a better password", "10.0.0.1").ok());
  EXPECT_TRUE(access_->Admit(kList, login.token).has_value());
}

TEST_F(AccessControlTest, ChangedPasswordEndsTheOtherSessions) {
  const std::string stolen = LogIn("maria", kPassword)->token;
  const std::string own = LogIn("maria", kPassword)->token;
  const Caller caller = *access_->Admit(kList, own);
  ASSERT_TRUE(access_->ChangePassword(caller, kPassword, "a better password", "10.0.0.1").ok());
  EXPECT_FALSE(access_->Admit(kList, stolen).has_value());
  EXPECT_TRUE(access_->Admit(kList, own).has_value());
}

TEST_F(AccessControlTest, OpenStreamLosesItsRightsWithTheUser) {
  const std::string token = LogIn("maria", kPassword)->token;
  const Caller caller = *access_->Admit(kStart, token);
  EXPECT_TRUE(access_->Recheck(kStart, caller, false).ok());
  ASSERT_TRUE(access_->accounts().UpdateUser("maria", {.role = Role::kViewer}, 0).has_value());
  EXPECT_EQ(access_->Recheck(kStart, caller, false).code(), StatusCode::kPermissionDenied);
  EXPECT_TRUE(access_->Recheck(kList, caller, false).ok());
  ASSERT_TRUE(access_->accounts().UpdateUser("maria", {.disabled = true}, 0).has_value());
  EXPECT_EQ(access_->Recheck(kList, caller, false).reason(), "SESSION_ENDED");
}

TEST_F(AccessControlTest, OpenStreamLosesItsRightsWithTheSession) {
  const AccessControl::LoggedIn login = *LogIn("maria", kPassword);
  const Caller caller = *access_->Admit(kList, login.token);
  ASSERT_TRUE(access_->sessions().Remove(login.session.id, "").ok());
  EXPECT_EQ(access_->Recheck(kList, caller, true).code(), StatusCode::kUnauthenticated);
}

TEST_F(AccessControlTest, OpenStreamLosesItsRightsWithTheApiKey) {
  const Accounts::NewApiKey key = *access_->accounts().CreateApiKey({.name = "cell 7"});
  const Caller caller = *access_->Admit(kList, key.secret);
  EXPECT_TRUE(access_->Recheck(kList, caller, false).ok());
  ASSERT_TRUE(access_->accounts().RevokeApiKey(key.record.id).ok());
  EXPECT_EQ(access_->Recheck(kList, caller, false).code(), StatusCode::kUnauthenticated);
}

TEST_F(AccessControlTest, OpenStreamEndsWithTheLifetimeOfItsSession) {
  const Caller caller = *access_->Admit(kList, LogIn("maria", kPassword)->token);
  for (int i = 1; i < 12 * 3; ++i) {  // just below twelve hours, always in use
    clock_.Advance(minutes(20));
    EXPECT_TRUE(access_->Recheck(kList, caller, true).ok()) << i;
  }
  clock_.Advance(minutes(20));
  EXPECT_EQ(access_->Recheck(kList, caller, true).reason(), "SESSION_ENDED");
}

TEST_F(AccessControlTest, StreamThatIsReadKeepsItsSessionAlive) {
  const std::string token = LogIn("maria", kPassword)->token;
  const Caller caller = *access_->Admit(kList, token);
  clock_.Advance(minutes(20));
  EXPECT_TRUE(access_->Recheck(kList, caller, true).ok());
  clock_.Advance(minutes(20));
  EXPECT_TRUE(access_->Recheck(kList, caller, false).ok());
  clock_.Advance(minutes(20));
  EXPECT_FALSE(access_->Recheck(kList, caller, false).ok());
}

}  // namespace
}  // namespace vs
