#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "engine/base/status.h"

namespace vs::sim {

// A Unix socket that takes commands, one on each line, and answers each with one line.
class ControlSocket {
 public:
  // `handler` is called on the socket's own thread. UNAVAILABLE if there can be no socket at
  // `path`; one that a dead program left behind is replaced.
  static Result<std::unique_ptr<ControlSocket>> Listen(
      const std::string& path, std::function<std::string(std::string_view)> handler);
  ~ControlSocket();

 private:
  struct Connection {
    int fd;
    std::string unread;
  };

  ControlSocket(std::string path, int fd, std::function<std::string(std::string_view)> handler);
  void Run();
  // False when the connection is to be closed.
  bool Serve(Connection& connection);

  const std::string path_;
  const int fd_;
  const int quit_fd_;
  const std::function<std::string(std::string_view)> handler_;
  std::vector<Connection> connections_;
  std::thread thread_;
};

}  // namespace vs::sim
