#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "engine/base/status.h"

namespace vs {

// Where a server listens: "0.0.0.0:50051", "[::]:50051", "127.0.0.1:0" (any free port),
// "localhost:50051".
struct ListenAddress {
  std::string host;  // an IPv4 or IPv6 address in numbers, without brackets
  uint16_t port = 0;

  static Result<ListenAddress> Parse(std::string_view text);
  bool IsIpv6() const { return host.find(':') != std::string::npos; }
  // Reachable from this machine only.
  bool IsLoopback() const;
  std::string ToString() const;
};

}  // namespace vs
