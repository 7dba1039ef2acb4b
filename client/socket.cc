#include "client/socket.h"

#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>
#include <string>

namespace vs::client {
namespace {

tl::unexpected<Error> CannotConnect(const Address& address, int error) {
  const std::string server = address.ToString();
  if (error == ECONNREFUSED) {
    return Failure(Code::kUnavailable,
                   "nothing listens on " + server + ": is the server running, and on this port?",
                   "CONNECTION_REFUSED");
  }
  if (error == ETIMEDOUT) {
    return Failure(
        Code::kUnavailable,
        server + " does not answer: is the machine on, and the port open in its firewall?",
        "CONNECTION_TIMEOUT");
  }
  return Failure(Code::kUnavailable, "cannot connect to " + server + ": " + std::strerror(error),
                 "CONNECTION_FAILED");
}

// 0 once connected, else errno.
int Connect(int fd, const sockaddr* to, socklen_t size, Deadline deadline) {
  if (::connect(fd, to, size) == 0) return 0;
  if (errno != EINPROGRESS) return errno;
  if (!WaitFor(fd, POLLOUT, deadline)) return ETIMEDOUT;
  int error = 0;
  socklen_t error_size = sizeof(error);
  return ::getsockopt(fd, SOL_SOCKET, SO_ERROR, &error, &error_size) == 0 ? error : errno;
}

}  // namespace

Socket::~Socket() {
  if (fd_ >= 0) ::close(fd_);
}

bool WaitFor(int fd, short events, Deadline deadline) {
  for (;;) {
    const auto left =
        std::chrono::ceil<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
    pollfd poll{.fd = fd, .events = events, .revents = 0};
    const int ready = ::poll(&poll, 1, static_cast<int>(std::clamp<long>(left.count(), 0, 60'000)));
    if (ready > 0) return true;
    if (ready < 0 && errno != EINTR) return false;
    if (std::chrono::steady_clock::now() >= deadline) return false;
  }
}

Result<Socket> ConnectTcp(const Address& address, Deadline deadline) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const int failed =
      ::getaddrinfo(address.host.c_str(), std::to_string(address.port).c_str(), &hints, &found);
  if (failed != 0) {
    return Failure(Code::kUnavailable,
                   "the host \"" + address.host + "\" is not known: " + ::gai_strerror(failed),
                   "HOST_NOT_FOUND");
  }
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> list(found, ::freeaddrinfo);
  int error = ECONNREFUSED;
  for (const addrinfo* one = found; one != nullptr; one = one->ai_next) {
    Socket socket(::socket(one->ai_family, one->ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
    if (socket.fd() < 0) continue;
    error = Connect(socket.fd(), one->ai_addr, one->ai_addrlen, deadline);
    if (error == 0) return socket;
  }
  return CannotConnect(address, error);
}

}  // namespace vs::client
