#include "server/results/uuid.h"

#include <sys/random.h>

#include <algorithm>
#include <array>

#include "engine/base/check.h"

namespace vs {
namespace {

using Bytes = std::array<uint8_t, 16>;

Bytes RandomBytes() {
  Bytes bytes;
  // Up to 256 bytes are always given whole.
  VS_CHECK(getrandom(bytes.data(), bytes.size(), 0) == static_cast<ssize_t>(bytes.size()));
  return bytes;
}

std::string Format(Bytes bytes, uint8_t version) {
  bytes[6] = static_cast<uint8_t>((bytes[6] & 0x0f) | (version << 4));
  bytes[8] = static_cast<uint8_t>((bytes[8] & 0x3f) | 0x80);
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  text.reserve(36);
  for (size_t i = 0; i < bytes.size(); ++i) {
    if (i == 4 || i == 6 || i == 8 || i == 10) text += '-';
    text += kDigits[bytes[i] >> 4];
    text += kDigits[bytes[i] & 0x0f];
  }
  return text;
}

}  // namespace

std::string UuidV7Generator::Next(int64_t utc_ns) {
  // 48 bits of milliseconds and, in the 12 bits behind the version, fractions of one.
  const uint64_t now = static_cast<uint64_t>(std::max<int64_t>(utc_ns, 0));
  const uint64_t ms = now / 1'000'000;
  const uint64_t fraction = (now % 1'000'000) * 4096 / 1'000'000;
  last_ticks_ = std::max(last_ticks_ + 1, ms * 4096 + fraction);
  Bytes bytes = RandomBytes();
  for (int i = 0; i < 6; ++i) {
    bytes[i] = static_cast<uint8_t>((last_ticks_ >> 12) >> (40 - 8 * i));
  }
  bytes[6] = static_cast<uint8_t>((last_ticks_ >> 8) & 0x0f);
  bytes[7] = static_cast<uint8_t>(last_ticks_);
  return Format(bytes, 7);
}

std::string RandomUuid() { return Format(RandomBytes(), 4); }

}  // namespace vs
