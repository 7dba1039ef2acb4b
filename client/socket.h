#pragma once

#include <chrono>
#include <utility>

#include "client/address.h"
#include "client/error.h"

namespace vs::client {

using Deadline = std::chrono::steady_clock::time_point;

// A file descriptor that closes itself.
class Socket {
 public:
  explicit Socket(int fd) : fd_(fd) {}
  Socket(Socket&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Socket& operator=(Socket&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  ~Socket();

  int fd() const { return fd_; }

 private:
  int fd_;
};

// A connected TCP socket that does not block. Errors as FetchCertificate's.
Result<Socket> ConnectTcp(const Address& address, Deadline deadline);

// Whether `fd` is ready for `events` (POLLIN, POLLOUT) before the deadline.
bool WaitFor(int fd, short events, Deadline deadline);

}  // namespace vs::client
