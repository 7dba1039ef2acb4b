#include "engine/sim/gevsim/udp_socket.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "engine/base/str.h"

namespace vs::sim {
namespace {

uint32_t AddressOf(const sockaddr* address) {
  sockaddr_in in{};
  std::memcpy(&in, address, sizeof in);
  return ntohl(in.sin_addr.s_addr);
}

bool IsIpv4(const sockaddr* address) { return address != nullptr && address->sa_family == AF_INET; }

}  // namespace

Result<uint32_t> ParseAddress(const std::string& text) {
  in_addr address{};
  if (inet_pton(AF_INET, text.c_str(), &address) != 1) {
    return InvalidArgument(Str("'", text, "' is not an IPv4 address such as 127.0.0.1"));
  }
  return ntohl(address.s_addr);
}

std::string AddressText(uint32_t address) {
  return Str(address >> 24, ".", (address >> 16) & 255, ".", (address >> 8) & 255, ".",
             address & 255);
}

sockaddr_in ToSockaddr(const Endpoint& endpoint) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(endpoint.address);
  address.sin_port = htons(endpoint.port);
  return address;
}

UdpSocket::~UdpSocket() {
  if (fd_ >= 0) close(fd_);
}
UdpSocket::UdpSocket(UdpSocket&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
UdpSocket& UdpSocket::operator=(UdpSocket&& other) noexcept {
  std::swap(fd_, other.fd_);
  return *this;
}

Result<UdpSocket> UdpSocket::Bind(const Endpoint& local, bool shared) {
  UdpSocket made(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  const int on = 1;
  const sockaddr_in address = ToSockaddr(local);
  if (made.fd_ < 0 ||
      (shared && setsockopt(made.fd_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on) != 0) ||
      setsockopt(made.fd_, SOL_SOCKET, SO_BROADCAST, &on, sizeof on) != 0 ||
      bind(made.fd_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    return Unavailable(Str("cannot use ", AddressText(local.address), ":", local.port, ": ",
                           std::strerror(errno)));
  }
  return made;
}

uint16_t UdpSocket::LocalPort() const {
  sockaddr_in address{};
  socklen_t size = sizeof address;
  getsockname(fd_, reinterpret_cast<sockaddr*>(&address), &size);
  return ntohs(address.sin_port);
}

int UdpSocket::Receive(std::span<uint8_t> bytes, Endpoint* from) const {
  sockaddr_in address{};
  socklen_t size = sizeof address;
  const ssize_t count = recvfrom(fd_, bytes.data(), bytes.size(), MSG_DONTWAIT,
                                 reinterpret_cast<sockaddr*>(&address), &size);
  *from = {ntohl(address.sin_addr.s_addr), ntohs(address.sin_port)};
  return count > 0 ? static_cast<int>(count) : 0;
}

void UdpSocket::Send(std::span<const uint8_t> bytes, const Endpoint& to) const {
  const sockaddr_in address = ToSockaddr(to);
  // A datagram that cannot be sent is a datagram that was lost: the protocol lives with that.
  sendto(fd_, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&address),
         sizeof address);
}

Network FindNetwork(uint32_t address) {
  Network network;
  ifaddrs* list = nullptr;
  if (getifaddrs(&list) != 0) return network;
  for (const ifaddrs* entry = list; entry != nullptr; entry = entry->ifa_next) {
    if (!IsIpv4(entry->ifa_addr) || !IsIpv4(entry->ifa_netmask)) continue;
    const uint32_t mask = AddressOf(entry->ifa_netmask);
    if ((AddressOf(entry->ifa_addr) & mask) != (address & mask)) continue;
    network = {mask, address | ~mask};
    break;
  }
  freeifaddrs(list);
  return network;
}

}  // namespace vs::sim
