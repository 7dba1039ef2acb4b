#pragma once

#include <cstdint>
#include <string>

namespace vs::test {

// A TCP connection to this machine, for sending what no proper client sends.
class RawSocket {
 public:
  // Throws when nobody listens there.
  explicit RawSocket(uint16_t port);
  ~RawSocket();
  RawSocket(RawSocket&& other) noexcept;
  RawSocket& operator=(RawSocket&&) = delete;

  // False when the other side has closed.
  bool Send(const std::string& bytes);
  // Reads until the other side closes; false when it does not within a minute.
  bool WaitForClose();
  // True: closed by now. Does not wait.
  bool Closed();
  int fd() const { return fd_; }

 private:
  int fd_;
};

}  // namespace vs::test
