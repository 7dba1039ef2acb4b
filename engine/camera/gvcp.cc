#include "engine/camera/gvcp.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <map>
#include <optional>
#include <span>

#include "engine/base/str.h"

namespace vs {
namespace {

using SteadyClock = std::chrono::steady_clock;
using Milliseconds = std::chrono::milliseconds;
using Packet = std::vector<uint8_t>;

constexpr uint16_t kPort = 3956;
constexpr int kTries = 3;
constexpr size_t kHeaderBytes = 8;
constexpr size_t kDiscoveryBytes = 248;
constexpr int kLookForCancelMs = 50;
constexpr uint16_t kDiscovery = 0x0002;
constexpr uint16_t kReadRegister = 0x0080;
constexpr uint8_t kAckRequired = 0x01;
constexpr uint8_t kBroadcastAckAllowed = 0x10;

class Socket {
 public:
  Socket() : fd_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {}
  ~Socket() {
    if (fd_ >= 0) close(fd_);
  }
  Socket(Socket&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  Socket& operator=(Socket&&) = delete;

  int fd() const { return fd_; }

 private:
  int fd_;
};

std::optional<sockaddr_in> ParseAddress(const std::string& text, uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  if (inet_pton(AF_INET, text.c_str(), &address.sin_addr) != 1) return std::nullopt;
  return address;
}

std::string AddressText(in_addr address) {
  std::array<char, INET_ADDRSTRLEN> text{};
  inet_ntop(AF_INET, &address, text.data(), text.size());
  return text.data();
}

Status NoAddress(const std::string& text) {
  return InvalidArgument(Str("\"", text, "\" is not an IPv4 address; write it like 192.168.1.20"));
}

const sockaddr* Generic(const sockaddr_in& address) {
  return reinterpret_cast<const sockaddr*>(&address);
}

void PutU16(Packet& packet, uint16_t value) {
  packet.push_back(static_cast<uint8_t>(value >> 8));
  packet.push_back(static_cast<uint8_t>(value));
}

uint32_t U32At(std::span<const uint8_t> bytes, size_t offset) {
  return uint32_t{bytes[offset]} << 24 | uint32_t{bytes[offset + 1]} << 16 |
         uint32_t{bytes[offset + 2]} << 8 | bytes[offset + 3];
}

uint16_t U16At(std::span<const uint8_t> bytes, size_t offset) {
  return static_cast<uint16_t>(bytes[offset] << 8 | bytes[offset + 1]);
}

std::string TextAt(std::span<const uint8_t> bytes, size_t offset, size_t length) {
  const auto* text = reinterpret_cast<const char*>(bytes.data() + offset);
  return {text, strnlen(text, length)};
}

Packet Command(uint8_t flags, uint16_t command, uint16_t id, const Packet& payload) {
  Packet packet = {0x42, flags};
  PutU16(packet, command);
  PutU16(packet, static_cast<uint16_t>(payload.size()));
  PutU16(packet, id);
  packet.insert(packet.end(), payload.begin(), payload.end());
  return packet;
}

// The payload of an answer to `command`; nullopt when the bytes are something else.
std::optional<std::span<const uint8_t>> Answer(std::span<const uint8_t> packet, uint16_t command,
                                               uint16_t id, size_t payload_bytes) {
  if (packet.size() < kHeaderBytes + payload_bytes || U16At(packet, 0) != 0) return std::nullopt;
  if (U16At(packet, 2) != command + 1 || U16At(packet, 6) != id) return std::nullopt;
  return packet.subspan(kHeaderBytes);
}

FoundCamera Describe(std::span<const uint8_t> discovery) {
  FoundCamera camera;
  camera.address = AddressText({htonl(U32At(discovery, 0x24))});
  camera.model = TextAt(discovery, 0x48, 32) + " " + TextAt(discovery, 0x68, 32);
  camera.serial = TextAt(discovery, 0xd8, 16);
  camera.name = TextAt(discovery, 0xe8, 16);
  camera.uri = camera.serial.empty() ? "gev-ip:" + camera.address : "gev:" + camera.serial;
  return camera;
}

int RemainingMs(SteadyClock::time_point deadline) {
  const auto left = std::chrono::ceil<Milliseconds>(deadline - SteadyClock::now());
  return static_cast<int>(std::max<int64_t>(left.count(), 0));
}

std::span<const uint8_t> Receive(int fd, std::span<uint8_t> memory) {
  const ssize_t received = recv(fd, memory.data(), memory.size(), 0);
  return memory.first(static_cast<size_t>(std::max<ssize_t>(received, 0)));
}

// Sends a command to one camera until it answers.
Result<Packet> Ask(const std::string& address, uint16_t command, const Packet& payload,
                   size_t answer_bytes, Milliseconds timeout) {
  const auto target = ParseAddress(address, kPort);
  if (!target) return NoAddress(address);
  const Socket socket;
  std::array<uint8_t, 1024> memory;
  constexpr uint16_t kId = 1;  // the same in all tries, so that a late answer counts too
  const Packet packet = Command(kAckRequired, command, kId, payload);
  for (int i = 0; i < kTries; ++i) {
    if (sendto(socket.fd(), packet.data(), packet.size(), 0, Generic(*target), sizeof *target) <
        0) {
      return Unavailable(Str("cannot send to ", address, ": ", std::strerror(errno)));
    }
    const auto deadline = SteadyClock::now() + timeout / kTries;
    pollfd event{socket.fd(), POLLIN, 0};
    while (poll(&event, 1, RemainingMs(deadline)) > 0) {
      if (const auto answer = Answer(Receive(socket.fd(), memory), command, kId, answer_bytes)) {
        return Packet(answer->begin(), answer->end());
      }
    }
  }
  return Unavailable(Str("no camera answers at ", address,
                         "; check its power, its cable and that its address is in this network"));
}

// A socket for each interface, from which a discovery command went out as a broadcast.
std::vector<Socket> BroadcastDiscovery(uint16_t id) {
  std::vector<Socket> sockets;
  ifaddrs* interfaces = nullptr;
  if (getifaddrs(&interfaces) != 0) return sockets;
  const Packet packet = Command(kAckRequired | kBroadcastAckAllowed, kDiscovery, id, {});
  for (const ifaddrs* i = interfaces; i != nullptr; i = i->ifa_next) {
    if (i->ifa_addr == nullptr || i->ifa_netmask == nullptr || (i->ifa_flags & IFF_UP) == 0 ||
        i->ifa_addr->sa_family != AF_INET) {
      continue;
    }
    sockaddr_in local = *reinterpret_cast<const sockaddr_in*>(i->ifa_addr);
    const auto mask = reinterpret_cast<const sockaddr_in*>(i->ifa_netmask)->sin_addr.s_addr;
    local.sin_port = 0;
    Socket socket;
    const int on = 1;
    if (setsockopt(socket.fd(), SOL_SOCKET, SO_BROADCAST, &on, sizeof on) != 0 ||
        bind(socket.fd(), Generic(local), sizeof local) != 0) {
      continue;
    }
    sockaddr_in target = local;
    target.sin_port = htons(kPort);
    // A camera outside the subnet hears only the limited broadcast; an interface without a default
    // route knows only the directed one.
    for (const in_addr_t broadcast : {htonl(INADDR_BROADCAST), local.sin_addr.s_addr | ~mask}) {
      target.sin_addr.s_addr = broadcast;
      (void)sendto(socket.fd(), packet.data(), packet.size(), 0, Generic(target), sizeof target);
    }
    sockets.push_back(std::move(socket));
  }
  freeifaddrs(interfaces);
  return sockets;
}

}  // namespace

Result<std::vector<FoundCamera>> DiscoverGevCameras(Milliseconds timeout, const std::string& wanted,
                                                    const std::stop_token& cancelled) {
  constexpr uint16_t kId = 1;
  const auto deadline = SteadyClock::now() + timeout;
  const std::vector<Socket> sockets = BroadcastDiscovery(kId);
  if (sockets.empty()) return Unavailable("this machine has no network interface that is up");
  std::vector<pollfd> events;
  events.reserve(sockets.size());
  for (const Socket& socket : sockets) events.push_back({socket.fd(), POLLIN, 0});
  std::map<uint32_t, FoundCamera> by_address;
  std::array<uint8_t, 1024> memory;
  bool complete = false;
  while (!complete && RemainingMs(deadline) > 0) {
    if (cancelled.stop_requested()) return Cancelled("the search for cameras was cancelled");
    const int wait_ms = std::min(RemainingMs(deadline), kLookForCancelMs);
    if (poll(events.data(), events.size(), wait_ms) <= 0) continue;
    for (pollfd& event : events) {
      if ((event.revents & POLLIN) == 0) {
        if (event.revents != 0) event.fd = -1;  // this network is gone: hear it no more
        continue;
      }
      const auto answer = Answer(Receive(event.fd, memory), kDiscovery, kId, kDiscoveryBytes);
      if (!answer) continue;
      const FoundCamera camera = Describe(*answer);
      complete = complete || (!wanted.empty() && camera.serial == wanted);
      by_address[U32At(*answer, 0x24)] = camera;
    }
  }
  std::vector<FoundCamera> cameras;
  cameras.reserve(by_address.size());
  for (auto& [address, camera] : by_address) cameras.push_back(std::move(camera));
  return cameras;
}

Result<FoundCamera> IdentifyGevCamera(const std::string& address, Milliseconds timeout) {
  VS_ASSIGN_OR_RETURN(const Packet answer, Ask(address, kDiscovery, {}, kDiscoveryBytes, timeout));
  return Describe(answer);
}

Result<uint32_t> ReadGevRegister(const std::string& address, uint32_t register_address,
                                 Milliseconds timeout) {
  Packet payload;
  PutU16(payload, static_cast<uint16_t>(register_address >> 16));
  PutU16(payload, static_cast<uint16_t>(register_address));
  VS_ASSIGN_OR_RETURN(const Packet answer,
                      Ask(address, kReadRegister, payload, sizeof(uint32_t), timeout));
  return U32At(answer, 0);
}

Result<std::string> LocalAddressFor(const std::string& address) {
  const auto target = ParseAddress(address, kPort);
  if (!target) return NoAddress(address);
  const Socket socket;
  sockaddr_in local{};
  socklen_t length = sizeof local;
  if (connect(socket.fd(), Generic(*target), sizeof *target) != 0 ||
      getsockname(socket.fd(), reinterpret_cast<sockaddr*>(&local), &length) != 0) {
    return Unavailable(Str("there is no network route to ", address, ": ", std::strerror(errno)));
  }
  return AddressText(local.sin_addr);
}

int MtuOf(const std::string& local_address) {
  int mtu_bytes = 1500;
  ifaddrs* interfaces = nullptr;
  if (getifaddrs(&interfaces) != 0) return mtu_bytes;
  const Socket socket;
  for (const ifaddrs* i = interfaces; i != nullptr; i = i->ifa_next) {
    if (i->ifa_addr == nullptr || i->ifa_addr->sa_family != AF_INET) continue;
    const auto* address = reinterpret_cast<const sockaddr_in*>(i->ifa_addr);
    if (AddressText(address->sin_addr) != local_address) continue;
    ifreq request{};
    std::strncpy(request.ifr_name, i->ifa_name, IFNAMSIZ - 1);
    if (ioctl(socket.fd(), SIOCGIFMTU, &request) == 0) mtu_bytes = request.ifr_mtu;
  }
  freeifaddrs(interfaces);
  return mtu_bytes;
}

}  // namespace vs
