#pragma once

#include <cstdint>

#include <google/protobuf/duration.pb.h>
#include <google/protobuf/timestamp.pb.h>

namespace vs {

// Nanoseconds since 1970-01-01 UTC. What lies outside 1678 to 2262 becomes the nearest of these.
google::protobuf::Timestamp ToTimestamp(int64_t utc_ns);
int64_t ToUtcNs(const google::protobuf::Timestamp& timestamp);

// What is longer than 292 years becomes 292 years.
google::protobuf::Duration ToDuration(int64_t duration_ns);
int64_t ToNs(const google::protobuf::Duration& duration);

}  // namespace vs
