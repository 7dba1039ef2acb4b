#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

namespace vs {

// How long a client may take to read what it is sent.
struct Patience {
  // The slowest reader that is served, in bytes per second: 1 Mbit/s, a mobile connection at the
  // edge of its cell. Who reads more slowly gets nothing of use, but would hold memory and a
  // thread.
  static constexpr int64_t kLeastBytesPerS = 128 << 10;

  // A client that reads nothing at all for so long is not waited for.
  std::chrono::milliseconds silence{5'000};
  int64_t least_bytes_per_s = kLeastBytesPerS;

  // For all of `size_bytes`, however they trickle.
  std::chrono::milliseconds For(size_t size_bytes) const {
    return silence +
           std::chrono::milliseconds(static_cast<int64_t>(size_bytes) * 1000 / least_bytes_per_s);
  }
};

}  // namespace vs
