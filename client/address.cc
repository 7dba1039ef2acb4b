#include "client/address.h"

#include <arpa/inet.h>
#include <netinet/in.h>

#include <algorithm>
#include <charconv>

namespace vs::client {
namespace {

tl::unexpected<Error> Malformed(std::string_view text) {
  return Failure(Code::kInvalidArgument,
                 "\"" + std::string(text) +
                     "\" is no address of a server; write HOST, HOST:PORT or [IPV6]:PORT");
}

}  // namespace

std::string Address::ToString() const {
  const std::string shown = host.find(':') == std::string::npos ? host : "[" + host + "]";
  return shown + ":" + std::to_string(port);
}

bool Address::IsLoopback() const {
  if (host == "localhost") return true;
  in_addr v4{};
  if (inet_pton(AF_INET, host.c_str(), &v4) == 1) return ntohl(v4.s_addr) >> 24 == 127;
  in6_addr v6{};
  return inet_pton(AF_INET6, host.c_str(), &v6) == 1 && IN6_IS_ADDR_LOOPBACK(&v6);
}

Result<Address> ParseAddress(std::string_view text) {
  Address address;
  std::string_view host = text;
  std::string_view port;
  if (text.starts_with('[')) {
    const size_t close = text.find(']');
    if (close == std::string_view::npos) return Malformed(text);
    host = text.substr(1, close - 1);
    port = text.substr(close + 1);
    if (!port.empty() && port[0] != ':') return Malformed(text);
  } else if (std::count(text.begin(), text.end(), ':') == 1) {
    host = text.substr(0, text.find(':'));
    port = text.substr(text.find(':'));
  }
  if (host.empty() || host.find_first_of(" /[]") != std::string_view::npos) return Malformed(text);
  address.host = host;
  if (!port.empty()) {
    const char* end = port.data() + port.size();
    const auto [rest, error] = std::from_chars(port.data() + 1, end, address.port);
    if (error != std::errc() || rest != end || address.port < 1 || address.port > 65535) {
      return Malformed(text);
    }
  }
  return address;
}

}  // namespace vs::client
