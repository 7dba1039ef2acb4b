#include "server/access/accounts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "tests/support/fake_clock.h"
#include "tests/support/temp_folder.h"

namespace vs {
namespace {

using std::chrono::hours;
using std::chrono::minutes;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr const char* kPassword = "correct horse battery";

class AccountsTest : public ::testing::Test {
 protected:
  void SetUp() override { Reopen(); }
  void Reopen() {
    accounts_.reset();
    database_.reset();
    database_ = *AccessDatabase::Open(folder_ / "users.db");
    accounts_ = *Accounts::Open(*database_, hasher_, clock_);
  }
  // With a password of their own.
  void AddUser(const std::string& name, Role role = Role::kViewer) {
    const std::string one_time = *accounts_->CreateUser({.name = name, .role = role});
    ASSERT_TRUE(accounts_->ChangePassword(name, one_time, kPassword).ok());
  }
  bool CanLogIn(const std::string& name, const std::string& password) {
    return accounts_->LogIn(name, password)->has_value();
  }

  test::TempFolder folder_;
  test::FakeClock clock_;
  PasswordHasher hasher_{{.passes = 1, .memory_bytes = 8192}};
  std::unique_ptr<AccessDatabase> database_;
  std::unique_ptr<Accounts> accounts_;
};

TEST_F(AccountsTest, HasNoDefaultPassword) {
  ASSERT_TRUE(accounts_->FirstPassword()->has_value());
  for (const char* guess : {"", "admin", "password", "visionserver", "Admin", "changeme"}) {
    EXPECT_FALSE(CanLogIn("admin", guess)) << guess;
  }
}

TEST_F(AccountsTest, FirstPasswordWorksOnce) {
  const std::string password = **accounts_->FirstPassword();
  EXPECT_TRUE(CanLogIn("admin", password));
  EXPECT_FALSE(CanLogIn("admin", password));
  EXPECT_EQ(accounts_->FindUser("admin")->role, Role::kAdmin);
  EXPECT_TRUE(accounts_->FindUser("admin")->must_change_password);
}

TEST_F(AccountsTest, FirstPasswordIsNewAtEachStartUntilSomebodyLoggedIn) {
  const std::string first = **accounts_->FirstPassword();
  Reopen();
  const std::string second = **accounts_->FirstPassword();
  EXPECT_FALSE(CanLogIn("admin", first));
  EXPECT_TRUE(CanLogIn("admin", second));
  Reopen();
  EXPECT_FALSE(accounts_->FirstPassword()->has_value());
}

TEST_F(AccountsTest, OneTimePasswordEndsAfterADay) {
  const std::string password = *accounts_->CreateUser({.name = "maria"});
  clock_.Advance(hours(24));
  EXPECT_FALSE(CanLogIn("maria", password));
}

TEST_F(AccountsTest, ChangedPasswordCountsFromThenOn) {
  const std::string one_time = *accounts_->CreateUser({.name = "maria"});
  ASSERT_TRUE(CanLogIn("maria", one_time));
  ASSERT_TRUE(accounts_->ChangePassword("maria", one_time, kPassword).ok());
  EXPECT_FALSE(accounts_->FindUser("maria")->must_change_password);
  EXPECT_FALSE(CanLogIn("maria", one_time));
  clock_.Advance(hours(48));
  EXPECT_TRUE(CanLogIn("maria", kPassword));
  EXPECT_TRUE(CanLogIn("MARIA", kPassword));
  Reopen();
  EXPECT_TRUE(CanLogIn("maria", kPassword));
}

TEST_F(AccountsTest, PasswordIsChangedOnlyByWhoKnowsTheOldOne) {
  AddUser("maria");
  EXPECT_EQ(accounts_->ChangePassword("maria", "a wrong one!", "another good one").code(),
            StatusCode::kPermissionDenied);
  EXPECT_EQ(accounts_->ChangePassword("maria", kPassword, "short").code(),
            StatusCode::kInvalidArgument);
  EXPECT_EQ(accounts_->ChangePassword("maria", kPassword, kPassword).code(),
            StatusCode::kInvalidArgument);
  EXPECT_TRUE(CanLogIn("maria", kPassword));
}

TEST_F(AccountsTest, UnknownUserCostsAsMuchWorkAsAWrongPassword) {
  AddUser("maria");
  AddUser("ben");
  ASSERT_TRUE(accounts_->UpdateUser("ben", {.disabled = true}, 0).has_value());
  const auto work = [&](const std::string& name, const std::string& password) {
    const uint64_t before = hasher_.Computed();
    EXPECT_FALSE(CanLogIn(name, password));
    return hasher_.Computed() - before;
  };
  EXPECT_EQ(work("maria", "a wrong one!"), 1U);
  EXPECT_EQ(work("nobody", "a wrong one!"), 1U);
  EXPECT_EQ(work("ben", kPassword), 1U);  // disabled
}

TEST_F(AccountsTest, HashOfLowerCostIsRenewedAtTheNextLogin) {
  AddUser("maria");
  const PasswordHasher stronger({.passes = 2, .memory_bytes = 16384});
  accounts_ = *Accounts::Open(*database_, stronger, clock_);
  EXPECT_TRUE(stronger.Outdated(accounts_->FindUser("maria")->password_hash));
  EXPECT_TRUE(CanLogIn("maria", kPassword));
  EXPECT_FALSE(stronger.Outdated(accounts_->FindUser("maria")->password_hash));
  EXPECT_TRUE(CanLogIn("maria", kPassword));
}

TEST_F(AccountsTest, NamesDifferByMoreThanCase) {
  AddUser("maria");
  EXPECT_EQ(accounts_->CreateUser({.name = "Maria"}).error().code(), StatusCode::kAlreadyExists);
  for (const char* name : {"", "9lives", "two words", "a\nb", "-x", "übung", "../etc"}) {
    EXPECT_EQ(accounts_->CreateUser({.name = name}).error().code(), StatusCode::kInvalidArgument)
        << name;
  }
  EXPECT_EQ(accounts_->CreateUser({.name = std::string(65, 'a')}).error().code(),
            StatusCode::kInvalidArgument);
}

TEST_F(AccountsTest, RobotsAreNotUsers) {
  EXPECT_EQ(accounts_->CreateUser({.name = "robot", .role = Role::kRobot}).error().code(),
            StatusCode::kInvalidArgument);
  AddUser("maria");
  EXPECT_EQ(accounts_->UpdateUser("maria", {.role = Role::kRobot}, 0).error().code(),
            StatusCode::kInvalidArgument);
}

TEST_F(AccountsTest, TwoEditorsDoNotOverwriteEachOther) {
  AddUser("root", Role::kAdmin);
  AddUser("maria");
  const int64_t revision = accounts_->FindUser("maria")->revision;
  ASSERT_TRUE(accounts_->UpdateUser("maria", {.role = Role::kOperator}, revision).has_value());
  EXPECT_EQ(accounts_->UpdateUser("maria", {.full_name = "Maria"}, revision).error().code(),
            StatusCode::kAborted);
  EXPECT_EQ(accounts_->FindUser("maria")->role, Role::kOperator);
}

TEST_F(AccountsTest, LastAdministratorStays) {
  AddUser("root", Role::kAdmin);
  AddUser("maria");
  EXPECT_EQ(accounts_->DeleteUser("root").code(), StatusCode::kFailedPrecondition);
  EXPECT_EQ(accounts_->UpdateUser("root", {.role = Role::kViewer}, 0).error().code(),
            StatusCode::kFailedPrecondition);
  EXPECT_EQ(accounts_->UpdateUser("root", {.disabled = true}, 0).error().code(),
            StatusCode::kFailedPrecondition);
  AddUser("second", Role::kAdmin);
  EXPECT_TRUE(accounts_->DeleteUser("root").ok());
  EXPECT_FALSE(accounts_->FindUser("root").has_value());
}

TEST_F(AccountsTest, RescueGivesADisabledAdministratorBack) {
  AddUser("admin", Role::kAdmin);
  AddUser("second", Role::kAdmin);
  ASSERT_TRUE(accounts_->UpdateUser("admin", {.disabled = true}, 0).has_value());
  const std::string password = *accounts_->RescueAdmin();
  EXPECT_TRUE(CanLogIn("admin", password));
}

TEST_F(AccountsTest, ApiKeyIsKnownByItsSecretOnly) {
  const Accounts::NewApiKey made = *accounts_->CreateApiKey({.name = "cell 7"});
  EXPECT_EQ(accounts_->FindApiKey(HashToken(made.secret))->name, "cell 7");
  EXPECT_FALSE(accounts_->FindApiKey(HashToken(made.record.id)).has_value());
  Reopen();
  EXPECT_EQ(accounts_->FindApiKey(HashToken(made.secret))->role, Role::kRobot);
  EXPECT_TRUE(accounts_->RevokeApiKey(made.record.id).ok());
  EXPECT_FALSE(accounts_->FindApiKey(HashToken(made.secret)).has_value());
  EXPECT_EQ(accounts_->RevokeApiKey(made.record.id).code(), StatusCode::kNotFound);
  Reopen();
  EXPECT_THAT(accounts_->ApiKeys(), IsEmpty());
}

TEST_F(AccountsTest, ApiKeyEndsWhenItWasSaidTo) {
  const Accounts::NewApiKey made = *accounts_->CreateApiKey(
      {.name = "guest", .expires_utc_ns = clock_.UtcNs() + 60'000'000'000});
  EXPECT_TRUE(accounts_->FindApiKey(HashToken(made.secret)).has_value());
  clock_.Advance(minutes(1));
  EXPECT_FALSE(accounts_->FindApiKey(HashToken(made.secret)).has_value());
}

TEST_F(AccountsTest, ApiKeysAreForMachines) {
  EXPECT_EQ(accounts_->CreateApiKey({.name = "x", .role = Role::kAdmin}).error().code(),
            StatusCode::kInvalidArgument);
  EXPECT_EQ(accounts_->CreateApiKey({.name = ""}).error().code(), StatusCode::kInvalidArgument);
  ASSERT_TRUE(accounts_->CreateApiKey({.name = "x"}).has_value());
  EXPECT_EQ(accounts_->CreateApiKey({.name = "x"}).error().code(), StatusCode::kAlreadyExists);
}

TEST_F(AccountsTest, NoSecretIsInTheFiles) {
  AddUser("maria");
  const Accounts::NewApiKey key = *accounts_->CreateApiKey({.name = "cell 7"});
  accounts_.reset();
  for (const auto& file : std::filesystem::directory_iterator(folder_.path())) {
    std::ifstream stream(file.path(), std::ios::binary);
    const std::string content((std::istreambuf_iterator<char>(stream)), {});
    EXPECT_THAT(content, Not(HasSubstr(kPassword))) << file.path();
    EXPECT_THAT(content, Not(HasSubstr(key.secret))) << file.path();
    const auto rights = std::filesystem::status(file.path()).permissions();
    EXPECT_EQ(rights & std::filesystem::perms(077), std::filesystem::perms::none) << file.path();
  }
}

}  // namespace
}  // namespace vs
