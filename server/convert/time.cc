#include "server/convert/time.h"

#include <algorithm>

namespace vs {
namespace {

constexpr int64_t kSecondNs = 1'000'000'000;
constexpr int64_t kMaxSeconds = INT64_MAX / kSecondNs - 1;

int64_t Join(int64_t seconds, int32_t nanos) {
  return std::clamp(seconds, -kMaxSeconds, kMaxSeconds) * kSecondNs +
         std::clamp<int64_t>(nanos, -kSecondNs, kSecondNs);
}

}  // namespace

google::protobuf::Timestamp ToTimestamp(int64_t utc_ns) {
  google::protobuf::Timestamp timestamp;
  // The fraction counts forward, also before 1970.
  const int64_t nanos = ((utc_ns % kSecondNs) + kSecondNs) % kSecondNs;
  timestamp.set_seconds((utc_ns - nanos) / kSecondNs);
  timestamp.set_nanos(static_cast<int32_t>(nanos));
  return timestamp;
}

int64_t ToUtcNs(const google::protobuf::Timestamp& timestamp) {
  return Join(timestamp.seconds(), timestamp.nanos());
}

google::protobuf::Duration ToDuration(int64_t duration_ns) {
  google::protobuf::Duration duration;
  duration.set_seconds(duration_ns / kSecondNs);
  duration.set_nanos(static_cast<int32_t>(duration_ns % kSecondNs));
  return duration;
}

int64_t ToNs(const google::protobuf::Duration& duration) {
  return Join(duration.seconds(), duration.nanos());
}

}  // namespace vs
