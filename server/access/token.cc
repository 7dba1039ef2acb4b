#include "server/access/token.h"

#include <sodium.h>

#include <cstring>

#include "engine/base/check.h"

namespace vs {
namespace {

void RequireSodium() {
  static const bool ready = sodium_init() >= 0;
  VS_CHECK(ready);
}

}  // namespace

TokenHash HashToken(std::string_view token) {
  TokenHash hash;
  crypto_generichash(hash.data(), hash.size(), reinterpret_cast<const unsigned char*>(token.data()),
                     token.size(), nullptr, 0);
  return hash;
}

std::string ToHex(const TokenHash& hash) {
  std::string hex(hash.size() * 2 + 1, '\0');
  sodium_bin2hex(hex.data(), hex.size(), hash.data(), hash.size());
  hex.pop_back();
  return hex;
}

TokenHash TokenHashFromHex(std::string_view hex) {
  TokenHash hash{};
  size_t bytes = 0;
  if (sodium_hex2bin(hash.data(), hash.size(), hex.data(), hex.size(), nullptr, &bytes, nullptr) !=
          0 ||
      bytes != hash.size()) {
    hash.fill(0);
  }
  return hash;
}

size_t TokenHashHasher::operator()(const TokenHash& hash) const {
  size_t value = 0;
  std::memcpy(&value, hash.data(), sizeof value);
  return value;
}

std::string MakeToken(std::string_view prefix) {
  RequireSodium();
  std::array<unsigned char, 32> random;
  randombytes_buf(random.data(), random.size());
  std::string text(
      sodium_base64_ENCODED_LEN(random.size(), sodium_base64_VARIANT_URLSAFE_NO_PADDING), '\0');
  sodium_bin2base64(text.data(), text.size(), random.data(), random.size(),
                    sodium_base64_VARIANT_URLSAFE_NO_PADDING);
  text.pop_back();  // the terminating zero
  sodium_memzero(random.data(), random.size());
  return std::string(prefix) + text;
}

std::string MakeId() {
  RequireSodium();
  std::array<unsigned char, 8> random;
  randombytes_buf(random.data(), random.size());
  std::string hex(random.size() * 2 + 1, '\0');
  sodium_bin2hex(hex.data(), hex.size(), random.data(), random.size());
  hex.pop_back();
  return hex;
}

std::string MakeOneTimePassword() {
  RequireSodium();
  static constexpr std::string_view kAlphabet = "abcdefghjkmnpqrstuvwxyz23456789";
  std::string password;
  for (int i = 0; i < 20; ++i) {
    if (i > 0 && i % 5 == 0) password += '-';
    password += kAlphabet[randombytes_uniform(kAlphabet.size())];
  }
  return password;
}

}  // namespace vs
