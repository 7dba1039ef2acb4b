#include "server/transport/listen_address.h"

#include <arpa/inet.h>
#include <netinet/in.h>

#include <charconv>

#include "engine/base/str.h"

namespace vs {
namespace {

Status Malformed(std::string_view text) {
  return InvalidArgument(Str("\"", text, "\" is not an address to listen on: write an IP address",
                             " and a port such as 0.0.0.0:50051, [::]:50051 or localhost:50051"));
}

}  // namespace

Result<ListenAddress> ListenAddress::Parse(std::string_view text) {
  const size_t colon = text.rfind(':');
  if (colon == std::string_view::npos) return Malformed(text);
  std::string_view host = text.substr(0, colon);
  const std::string_view port = text.substr(colon + 1);

  ListenAddress address;
  const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), address.port);
  if (port.empty() || error != std::errc() || end != port.data() + port.size()) {
    return Malformed(text);
  }
  const bool bracketed = host.size() > 2 && host.front() == '[' && host.back() == ']';
  if (bracketed) host = host.substr(1, host.size() - 2);
  address.host = host == "localhost" ? "127.0.0.1" : std::string(host);
  in_addr v4{};
  in6_addr v6{};
  const bool valid = bracketed ? inet_pton(AF_INET6, address.host.c_str(), &v6) == 1
                               : inet_pton(AF_INET, address.host.c_str(), &v4) == 1;
  if (!valid) return Malformed(text);
  return address;
}

bool ListenAddress::IsLoopback() const { return host.starts_with("127.") || host == "::1"; }

std::string ListenAddress::ToString() const {
  return IsIpv6() ? Str("[", host, "]:", port) : Str(host, ":", port);
}

}  // namespace vs
