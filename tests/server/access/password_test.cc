#include "server/access/password.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vs {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

// libsodium's smallest: these tests are not about the cost.
constexpr PasswordCost kCheap = {.passes = 1, .memory_bytes = 8192};

TEST(PasswordHasher, AcceptsThePasswordAndNoOther) {
  const PasswordHasher hasher(kCheap);
  const std::string hash = *hasher.Hash("correct horse");
  EXPECT_TRUE(hasher.Verify(hash, "correct horse"));
  EXPECT_FALSE(hasher.Verify(hash, "correct horsf"));
  EXPECT_FALSE(hasher.Verify(hash, ""));
}

TEST(PasswordHasher, SaltsEachHash) {
  const PasswordHasher hasher(kCheap);
  EXPECT_NE(*hasher.Hash("correct horse"), *hasher.Hash("correct horse"));
}

TEST(PasswordHasher, HasTheCostOfLibsodiumsInteractiveProfileUnlessTold) {
  EXPECT_THAT(*PasswordHasher().Hash("correct horse"),
              StartsWith("$argon2id$v=19$m=65536,t=2,p=1$"));
}

TEST(PasswordHasher, DoesTheSameWorkForAHashThatFitsNothing) {
  const PasswordHasher hasher(kCheap);
  EXPECT_EQ(hasher.Computed(), 0);
  EXPECT_FALSE(hasher.Verify("", "anything"));
  EXPECT_FALSE(hasher.Verify("$argon2id$damaged", "anything"));
  EXPECT_FALSE(hasher.Verify(std::string(1000, 'x'), "anything"));
  EXPECT_EQ(hasher.Computed(), 3);
}

TEST(PasswordHasher, LooksAtEveryByteOfALongPassword) {
  const PasswordHasher hasher(kCheap);
  std::string password(1024, 'p');
  const std::string hash = *hasher.Hash(password);
  password.back() = 'q';
  EXPECT_FALSE(hasher.Verify(hash, password));
}

TEST(PasswordHasher, KnowsHashesOfLowerCost) {
  const std::string old = *PasswordHasher(kCheap).Hash("correct horse");
  const PasswordHasher stronger({.passes = 2, .memory_bytes = 16384});
  EXPECT_TRUE(stronger.Outdated(old));
  EXPECT_TRUE(stronger.Verify(old, "correct horse"));
  EXPECT_FALSE(stronger.Outdated(*stronger.Hash("correct horse")));
}

TEST(CheckNewPassword, TakesAnythingLongThatNobodyGuesses) {
  EXPECT_TRUE(CheckNewPassword("maria", "correct horse battery").ok());
  EXPECT_TRUE(CheckNewPassword("maria", "Grüße aus Köln").ok());
  EXPECT_TRUE(CheckNewPassword("maria", std::string("with a \0 zero", 13)).ok());
  EXPECT_TRUE(CheckNewPassword("maria", std::string(1000, 'a') + "bcdefghij").ok());
}

TEST(CheckNewPassword, NamesTheRuleThatIsBroken) {
  EXPECT_THAT(CheckNewPassword("maria", "nine char").message(), HasSubstr("too short"));
  // Nine characters in ten bytes.
  EXPECT_THAT(CheckNewPassword("maria", "nine chär").message(), HasSubstr("too short"));
  EXPECT_THAT(CheckNewPassword("maria", std::string(1025, 'a')).message(), HasSubstr("too long"));
  EXPECT_THAT(CheckNewPassword("maria.gonzales", "Maria.Gonzales").message(),
              HasSubstr("user name"));
  EXPECT_THAT(CheckNewPassword("maria", "mariamaria").message(), HasSubstr("user name"));
  EXPECT_THAT(CheckNewPassword("maria", "Password123").message(), HasSubstr("common"));
  EXPECT_THAT(CheckNewPassword("maria", "aaaaaaaaaaaa").message(), HasSubstr("common"));
}

}  // namespace
}  // namespace vs
