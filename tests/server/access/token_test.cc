#include "server/access/token.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace vs {
namespace {

TEST(Token, IsNewEachTime) {
  std::set<std::string> tokens;
  for (int i = 0; i < 10'000; ++i) tokens.insert(MakeToken("vst_"));
  EXPECT_EQ(tokens.size(), 10'000U);
  // The prefix, and 256 bits in base64: ceil(256 / 6) characters.
  EXPECT_EQ(tokens.begin()->size(), 4U + 43U);
}

TEST(Token, HashSurvivesStorage) {
  const TokenHash hash = HashToken("a token");
  EXPECT_EQ(TokenHashFromHex(ToHex(hash)), hash);
  EXPECT_NE(HashToken("a tokem"), hash);
  // BLAKE2b-256 of the empty input, from RFC 7693's reference program.
  EXPECT_EQ(ToHex(HashToken("")),
            "0e5751c026e543b2e8ab2eb06099daa1d1e5df47778f7787faab45cdf12fe3a8");
}

TEST(Token, HashOfNothingComesFromDamagedText) {
  EXPECT_EQ(TokenHashFromHex("not hex"), TokenHash{});
  EXPECT_EQ(TokenHashFromHex("0e57"), TokenHash{});
  EXPECT_EQ(TokenHashFromHex(std::string(128, 'a')), TokenHash{});
}

TEST(Token, OneTimePasswordCanBeReadAloud) {
  const std::string password = MakeOneTimePassword();
  EXPECT_EQ(password.size(), 23U);
  EXPECT_EQ(password.find_first_not_of("abcdefghjkmnpqrstuvwxyz23456789-"), std::string::npos);
  EXPECT_NE(password, MakeOneTimePassword());
}

}  // namespace
}  // namespace vs
