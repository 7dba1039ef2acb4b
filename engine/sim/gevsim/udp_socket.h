#pragma once

#include <netinet/in.h>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "engine/base/status.h"

namespace vs::sim {

// An IPv4 address and port, in host byte order.
struct Endpoint {
  uint32_t address = 0;
  uint16_t port = 0;

  bool operator==(const Endpoint&) const = default;
};

Result<uint32_t> ParseAddress(const std::string& text);
std::string AddressText(uint32_t address);
sockaddr_in ToSockaddr(const Endpoint& endpoint);

// Owns a UDP socket.
class UdpSocket {
 public:
  UdpSocket() = default;
  ~UdpSocket();
  UdpSocket(UdpSocket&& other) noexcept;
  UdpSocket& operator=(UdpSocket&& other) noexcept;

  // `shared` lets several sockets have the same address, each then gets its copy of a broadcast.
  static Result<UdpSocket> Bind(const Endpoint& local, bool shared = false);

  int fd() const { return fd_; }
  uint16_t LocalPort() const;
  // Takes a datagram that has arrived; its size, or nothing.
  int Receive(std::span<uint8_t> bytes, Endpoint* from) const;
  void Send(std::span<const uint8_t> bytes, const Endpoint& to) const;

 private:
  explicit UdpSocket(int fd) : fd_(fd) {}

  int fd_ = -1;
};

// The network of one of the host's addresses.
struct Network {
  uint32_t mask = 0xffffff00;
  uint32_t broadcast = 0;  // 0 if it has none
};
// Of the interface that serves `address`.
Network FindNetwork(uint32_t address);

}  // namespace vs::sim
