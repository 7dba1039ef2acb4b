#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

namespace vs {

// BLAKE2b of a token: what is stored and looked up, so that neither a copy of the database nor the
// time of a look-up tells a token.
using TokenHash = std::array<unsigned char, 32>;
TokenHash HashToken(std::string_view token);
std::string ToHex(const TokenHash& hash);
// Zeroes when `hex` is not the hash of anything.
TokenHash TokenHashFromHex(std::string_view hex);

// For std::unordered_map: the bytes are random already.
struct TokenHashHasher {
  size_t operator()(const TokenHash& hash) const;
};

// A new secret of 256 random bits: `prefix` (which tells people what it is) and 43 characters that
// need no quoting.
std::string MakeToken(std::string_view prefix);
// Names a thing that is not secret: 16 hexadecimal digits.
std::string MakeId();
// A password to be read and typed once: 20 letters and digits that look different, in groups of
// five; 98 random bits.
std::string MakeOneTimePassword();

}  // namespace vs
