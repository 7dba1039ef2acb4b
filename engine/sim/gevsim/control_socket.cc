#include "engine/sim/gevsim/control_socket.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "engine/base/str.h"

namespace vs::sim {

Result<std::unique_ptr<ControlSocket>> ControlSocket::Listen(
    const std::string& path, std::function<std::string(std::string_view)> handler) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path) {
    return InvalidArgument(Str("the path of a socket has at most ", sizeof address.sun_path - 1,
                               " characters: ", path));
  }
  path.copy(address.sun_path, path.size());
  const int fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  unlink(path.c_str());
  if (fd < 0 || bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      listen(fd, 8) != 0) {
    const Status error = Unavailable(Str("cannot listen at ", path, ": ", std::strerror(errno)));
    if (fd >= 0) close(fd);
    return error;
  }
  return std::unique_ptr<ControlSocket>(new ControlSocket(path, fd, std::move(handler)));
}

ControlSocket::ControlSocket(std::string path, int fd,
                             std::function<std::string(std::string_view)> handler)
    : path_(std::move(path)),
      fd_(fd),
      quit_fd_(eventfd(0, EFD_CLOEXEC)),
      handler_(std::move(handler)),
      thread_([this] { Run(); }) {}

ControlSocket::~ControlSocket() {
  eventfd_write(quit_fd_, 1);
  thread_.join();
  for (const Connection& connection : connections_) close(connection.fd);
  close(fd_);
  close(quit_fd_);
  unlink(path_.c_str());
}

void ControlSocket::Run() {
  while (true) {
    std::vector<pollfd> waiting = {{quit_fd_, POLLIN, 0}, {fd_, POLLIN, 0}};
    for (const Connection& connection : connections_) waiting.push_back({connection.fd, POLLIN, 0});
    poll(waiting.data(), waiting.size(), -1);
    if (waiting[0].revents != 0) return;
    for (size_t i = waiting.size(); i-- > 2;) {
      if (waiting[i].revents == 0 || Serve(connections_[i - 2])) continue;
      close(waiting[i].fd);
      connections_.erase(connections_.begin() + static_cast<ptrdiff_t>(i - 2));
    }
    if (waiting[1].revents != 0) {
      const int fd = accept4(fd_, nullptr, nullptr, SOCK_CLOEXEC);
      if (fd >= 0) connections_.push_back({fd, {}});
    }
  }
}

bool ControlSocket::Serve(Connection& connection) {
  constexpr size_t kLongestLine = 4096;
  std::array<char, 512> bytes;
  const ssize_t count = recv(connection.fd, bytes.data(), bytes.size(), MSG_DONTWAIT);
  if (count <= 0) return false;
  connection.unread.append(bytes.data(), static_cast<size_t>(count));
  for (size_t end; (end = connection.unread.find('\n')) != std::string::npos;) {
    const std::string answer = handler_(std::string_view(connection.unread).substr(0, end)) + "\n";
    connection.unread.erase(0, end + 1);
    // Whoever does not read the answers is not worth waiting for.
    if (send(connection.fd, answer.data(), answer.size(), MSG_DONTWAIT | MSG_NOSIGNAL) < 0) {
      return false;
    }
  }
  return connection.unread.size() <= kLongestLine;
}

}  // namespace vs::sim
