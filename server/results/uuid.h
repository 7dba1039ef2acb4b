#pragma once

#include <cstdint>
#include <string>

namespace vs {

// UUIDs of version 7 (RFC 9562, method 3): they sort by time of creation, also within one
// millisecond and when the wall clock is set back. Not thread-safe.
class UuidV7Generator {
 public:
  // `utc_ns`: now, nanoseconds since 1970.
  std::string Next(int64_t utc_ns);

 private:
  uint64_t last_ticks_ = 0;  // 1/4096 ms
};

// Version 4: random.
std::string RandomUuid();

}  // namespace vs
