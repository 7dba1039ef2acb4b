#include "engine/camera/gev_sockets.h"

#include <arpa/inet.h>
#include <dirent.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <optional>
#include <utility>

namespace vs {
namespace {

std::optional<UdpSocket> UdpSocketAt(int fd) {
  sockaddr_in local{};
  socklen_t length = sizeof local;
  int type = 0;
  socklen_t type_length = sizeof type;
  struct stat file {};
  if (getsockopt(fd, SOL_SOCKET, SO_TYPE, &type, &type_length) != 0 || type != SOCK_DGRAM ||
      getsockname(fd, reinterpret_cast<sockaddr*>(&local), &length) != 0 ||
      local.sin_family != AF_INET || fstat(fd, &file) != 0) {
    return std::nullopt;
  }
  std::array<char, INET_ADDRSTRLEN> text{};
  inet_ntop(AF_INET, &local.sin_addr, text.data(), text.size());
  return UdpSocket{fd, file.st_ino, text.data(), ntohs(local.sin_port)};
}

}  // namespace

std::vector<UdpSocket> UdpSocketsOfThisProcess() {
  std::vector<UdpSocket> sockets;
  DIR* directory = opendir("/proc/self/fd");
  if (directory == nullptr) return sockets;
  while (const dirent* entry = readdir(directory)) {
    if (auto socket = UdpSocketAt(std::atoi(entry->d_name))) sockets.push_back(std::move(*socket));
  }
  closedir(directory);
  return sockets;
}

void Silence(const UdpSocket& socket) {
  const int nowhere = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (nowhere < 0) return;
  dup3(nowhere, socket.fd, O_CLOEXEC);
  close(nowhere);
}

Mutex& AravisOpensSockets() {
  static Mutex mutex;
  return mutex;
}

}  // namespace vs
