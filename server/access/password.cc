#include "server/access/password.h"

#include <sodium.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <set>

#include "engine/base/check.h"
#include "server/access/token.h"

namespace vs {
namespace {

constexpr size_t kMinCharacters = 10;
constexpr size_t kMaxBytes = 1024;

// Of the lists of passwords found in leaks, those that the other rules let through, and what
// people think of first in front of this product.
constexpr std::array<std::string_view, 48> kCommon = {
    "1234567890",       "0123456789",    "0987654321",      "12345678910",    "123456789a",
    "a123456789",       "1q2w3e4r5t",    "1qaz2wsx3edc",    "qwertyuiop",     "qwerty1234",
    "qwerty12345",      "qwerty123456",  "asdfghjkl1",      "zaq12wsxcde3",   "password12",
    "password123",      "password1234",  "password12345",   "passw0rd123",    "p@ssw0rd123",
    "passwordpassword", "iloveyou123",   "welcome123",      "welcome1234",    "letmein1234",
    "changeme123",      "changemenow",   "administrator",   "administrator1", "adminadmin",
    "admin12345",       "admin123456",   "rootrootroot",    "operator123",    "engineer123",
    "visionserver",     "visionserver1", "visionserver123", "vision1234",     "stereovision",
    "controlvision",    "camera12345",   "robot12345",      "machinevision",  "industry40",
    "qazwsxedcrfv",     "football123",   "sunshine123"};

std::string Lower(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower;
}

size_t CountCharacters(std::string_view utf8) {
  return std::count_if(utf8.begin(), utf8.end(),
                       [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; });
}

}  // namespace

PasswordHasher::PasswordHasher(PasswordCost cost) : cost_(cost) {
  VS_CHECK(sodium_init() >= 0);
  const Result<std::string> decoy = Hash(MakeToken(""));
  VS_CHECK(decoy.has_value());
  decoy_ = *decoy;
  computed_ = 0;
}

Result<std::string> PasswordHasher::Hash(std::string_view password) const {
  ++computed_;
  std::array<char, crypto_pwhash_STRBYTES> text{};
  if (crypto_pwhash_str_alg(text.data(), password.data(), password.size(), cost_.passes,
                            cost_.memory_bytes, crypto_pwhash_ALG_ARGON2ID13) != 0) {
    return ResourceExhausted("not enough memory to hash a password; try again shortly");
  }
  return std::string(text.data());
}

bool PasswordHasher::Verify(const std::string& hash, std::string_view password) const {
  ++computed_;
  const bool usable = hash.size() < crypto_pwhash_STRBYTES && hash.starts_with("$argon2id$");
  std::array<char, crypto_pwhash_STRBYTES> text{};
  const std::string& chosen = usable ? hash : decoy_;
  std::copy(chosen.begin(), chosen.end(), text.begin());
  const bool fits = crypto_pwhash_str_verify(text.data(), password.data(), password.size()) == 0;
  return fits && usable;
}

bool PasswordHasher::Outdated(const std::string& hash) const {
  return crypto_pwhash_str_needs_rehash(hash.c_str(), cost_.passes, cost_.memory_bytes) != 0;
}

Status CheckNewPassword(std::string_view user, std::string_view password) {
  if (CountCharacters(password) < kMinCharacters) {
    return InvalidArgument("the new password is too short: take at least 10 characters");
  }
  if (password.size() > kMaxBytes) {
    return InvalidArgument("the new password is too long: take at most 1024 bytes");
  }
  const std::string lower = Lower(password);
  if (!user.empty() && (lower == Lower(user) || lower == Lower(user) + Lower(user))) {
    return InvalidArgument("the new password is the user name: take something nobody guesses");
  }
  const std::set<char> different(lower.begin(), lower.end());
  if (different.size() < 4 || std::find(kCommon.begin(), kCommon.end(), lower) != kCommon.end()) {
    return InvalidArgument("the new password is a common one: take something nobody guesses");
  }
  return Status();
}

}  // namespace vs
