#pragma once

#include <string>
#include <string_view>

#include "client/error.h"

namespace vs::client {

// Where servers listen unless told otherwise.
inline constexpr int kDefaultPort = 50051;

// "cell-7", "192.168.1.5:50051", "[fe80::1]:50051".
struct Address {
  std::string host;
  int port = kDefaultPort;

  // "cell-7:50051"; an IPv6 address in brackets.
  std::string ToString() const;
  // Whether it can only mean this machine itself.
  bool IsLoopback() const;
};

// INVALID_ARGUMENT for an empty host, a port outside 1..65535, or an IPv6 address with a port but
// without brackets.
Result<Address> ParseAddress(std::string_view text);

}  // namespace vs::client
