#include "engine/base/str.h"

#include <cstdint>
#include <cstdio>

namespace vs {
namespace {

constexpr int kMaxCharacters = 60;

bool IsContinuation(uint8_t byte) { return (byte & 0xc0) == 0x80; }

// Bytes of the well-formed UTF-8 character at the start of `text` (RFC 3629, table of section 4);
// 0 when there is none.
size_t CharacterBytes(std::string_view text) {
  const auto at = [text](size_t i) -> uint8_t { return i < text.size() ? text[i] : 0; };
  const uint8_t first = at(0);
  if (first < 0x80) return 1;
  if (first >= 0xc2 && first <= 0xdf) return IsContinuation(at(1)) ? 2 : 0;
  if (first >= 0xe0 && first <= 0xef) {
    const uint8_t low = first == 0xe0 ? 0xa0 : 0x80;
    const uint8_t high = first == 0xed ? 0x9f : 0xbf;
    return at(1) >= low && at(1) <= high && IsContinuation(at(2)) ? 3 : 0;
  }
  if (first >= 0xf0 && first <= 0xf4) {
    const uint8_t low = first == 0xf0 ? 0x90 : 0x80;
    const uint8_t high = first == 0xf4 ? 0x8f : 0xbf;
    return at(1) >= low && at(1) <= high && IsContinuation(at(2)) && IsContinuation(at(3)) ? 4 : 0;
  }
  return 0;
}

}  // namespace

std::string Quoted(std::string_view text) {
  std::string quoted = "\"";
  for (int characters = 0; !text.empty(); ++characters) {
    if (characters == kMaxCharacters) {
      quoted += "...";
      break;
    }
    const size_t bytes = CharacterBytes(text);
    const auto first = static_cast<uint8_t>(text[0]);
    if (bytes == 0 || first < 0x20 || first == 0x7f) {
      char hex[5];
      std::snprintf(hex, sizeof hex, "\\x%02x", first);
      quoted += hex;
      text.remove_prefix(1);
    } else {
      quoted += text.substr(0, bytes);
      text.remove_prefix(bytes);
    }
  }
  return quoted + "\"";
}

}  // namespace vs
