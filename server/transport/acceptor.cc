#include "server/transport/acceptor.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "engine/base/log.h"
#include "engine/base/str.h"

namespace vs {
namespace {

// Descriptors that are left to cameras, files and databases.
constexpr int kOtherFiles = 64;

struct SocketAddress {
  sockaddr_storage storage{};
  socklen_t size = sizeof storage;

  sockaddr* get() { return reinterpret_cast<sockaddr*>(&storage); }
};

SocketAddress ToSocketAddress(const ListenAddress& address) {
  SocketAddress result;
  if (address.IsIpv6()) {
    auto* v6 = reinterpret_cast<sockaddr_in6*>(&result.storage);
    v6->sin6_family = AF_INET6;
    v6->sin6_port = htons(address.port);
    inet_pton(AF_INET6, address.host.c_str(), &v6->sin6_addr);
    result.size = sizeof *v6;
  } else {
    auto* v4 = reinterpret_cast<sockaddr_in*>(&result.storage);
    v4->sin_family = AF_INET;
    v4->sin_port = htons(address.port);
    inet_pton(AF_INET, address.host.c_str(), &v4->sin_addr);
    result.size = sizeof *v4;
  }
  return result;
}

std::string HostOf(const SocketAddress& address) {
  std::array<char, INET6_ADDRSTRLEN> text{};
  if (address.storage.ss_family == AF_INET6) {
    const auto* v6 = reinterpret_cast<const sockaddr_in6*>(&address.storage);
    if (IN6_IS_ADDR_V4MAPPED(&v6->sin6_addr)) {  // the same client as on an IPv4 socket
      inet_ntop(AF_INET, &v6->sin6_addr.s6_addr[12], text.data(), text.size());
    } else {
      inet_ntop(AF_INET6, &v6->sin6_addr, text.data(), text.size());
    }
  } else {
    const auto* v4 = reinterpret_cast<const sockaddr_in*>(&address.storage);
    inet_ntop(AF_INET, &v4->sin_addr, text.data(), text.size());
  }
  return text.data();
}

int LimitByOpenFiles(int wanted) {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return wanted;
  const auto files = static_cast<int64_t>(limit.rlim_cur);
  return static_cast<int>(std::clamp<int64_t>(files - kOtherFiles, 1, wanted));
}

void SetOption(int fd, int level, int option, int64_t value) {
  const auto number = static_cast<int>(value);
  ::setsockopt(fd, level, option, &number, sizeof number);
}

int OpenReserve() { return ::open("/dev/null", O_RDONLY | O_CLOEXEC); }

Status SystemError(std::string_view what, const ListenAddress& address) {
  return FailedPrecondition(
      Str("cannot ", what, " ", address.ToString(), ": ", std::strerror(errno)));
}

}  // namespace

Result<std::unique_ptr<Acceptor>> Acceptor::Listen(const AcceptorOptions& options) {
  SocketAddress address = ToSocketAddress(options.address);
  const int listener =
      ::socket(address.storage.ss_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, IPPROTO_TCP);
  if (listener < 0) return SystemError("open a socket for", options.address);
  const int on = 1;
  const int off = 0;
  ::setsockopt(listener, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  if (options.address.IsIpv6()) {
    ::setsockopt(listener, IPPROTO_IPV6, IPV6_V6ONLY, &off, sizeof off);
  }
  if (::bind(listener, address.get(), address.size) != 0 || ::listen(listener, SOMAXCONN) != 0 ||
      ::getsockname(listener, address.get(), &address.size) != 0) {
    const Status error = SystemError("listen on", options.address);
    ::close(listener);
    return error;
  }
  const int stop_event = ::eventfd(0, EFD_CLOEXEC);
  if (stop_event < 0) {
    const Status error = SystemError("listen on", options.address);
    ::close(listener);
    return error;
  }
  const uint16_t port = ntohs(
      options.address.IsIpv6() ? reinterpret_cast<const sockaddr_in6*>(&address.storage)->sin6_port
                               : reinterpret_cast<const sockaddr_in*>(&address.storage)->sin_port);
  return std::unique_ptr<Acceptor>(new Acceptor(options, listener, stop_event, port));
}

Acceptor::Acceptor(const AcceptorOptions& options, int listener, int stop_event, uint16_t port)
    : options_(options),
      max_connections_(LimitByOpenFiles(options.max_connections)),
      listener_(listener),
      stop_event_(stop_event),
      port_(port),
      reserve_(OpenReserve()) {
  if (max_connections_ < options.max_connections) {
    LogWarn("transport",
            Str("takes ", max_connections_, " connections, not ", options.max_connections,
                ": raise the limit of open files (LimitNOFILE, ulimit -n)"));
  }
}

Acceptor::~Acceptor() {
  Stop();
  ::close(listener_);
  ::close(stop_event_);
  if (reserve_ >= 0) ::close(reserve_);
}

void Acceptor::Start(Take take) {
  take_ = std::move(take);
  thread_ = std::jthread([this] { Run(); });
}

void Acceptor::Forget(int fd) {
  MutexLock lock(mutex_);
  connections_.erase(fd);
}

void Acceptor::Stop() {
  if (!thread_.joinable()) return;
  const uint64_t one = 1;
  [[maybe_unused]] const ssize_t written = ::write(stop_event_, &one, sizeof one);
  thread_.join();
}

void Acceptor::Run() {
  while (true) {
    std::array<pollfd, 2> waiting = {pollfd{listener_, POLLIN, 0}, pollfd{stop_event_, POLLIN, 0}};
    if (::poll(waiting.data(), waiting.size(), -1) < 0) continue;
    if (waiting[1].revents != 0) return;
    if (waiting[0].revents != 0) AcceptOne();
  }
}

void Acceptor::AcceptOne() {
  SocketAddress peer;
  const int fd = ::accept4(listener_, peer.get(), &peer.size, SOCK_CLOEXEC | SOCK_NONBLOCK);
  if (fd < 0) {
    if (errno == EMFILE || errno == ENFILE || errno == ENOMEM || errno == ENOBUFS) TurnOneAway();
    return;  // anything else is about this one connection only
  }
  const std::string address = HostOf(peer);
  if (!Admit(fd, address)) {
    ::close(fd);
    return;
  }
  SetOption(fd, IPPROTO_TCP, TCP_NODELAY, 1);
  if (options_.keepalive.count() > 0) {
    const auto quiet = std::chrono::ceil<std::chrono::seconds>(options_.keepalive);
    SetOption(fd, SOL_SOCKET, SO_KEEPALIVE, 1);
    SetOption(fd, IPPROTO_TCP, TCP_KEEPIDLE, quiet.count());
    SetOption(fd, IPPROTO_TCP, TCP_KEEPINTVL, std::max<int64_t>(1, quiet.count() / 2));
    SetOption(fd, IPPROTO_TCP, TCP_USER_TIMEOUT, options_.vanished.count());
  }
  take_(fd, address);
}

void Acceptor::TurnOneAway() {
  {
    MutexLock lock(mutex_);
    ++refused_;
  }
  if (reserve_ >= 0) ::close(reserve_);
  const int fd = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
  if (fd >= 0) ::close(fd);
  reserve_ = OpenReserve();
  if (fd < 0) {
    // Somebody else was quicker to take the reserve: wait instead of spinning.
    pollfd stop = {stop_event_, POLLIN, 0};
    ::poll(&stop, 1, 50);
  }
}

bool Acceptor::Admit(int fd, const std::string& address) {
  struct stat status {};
  if (::fstat(fd, &status) != 0) return false;
  MutexLock lock(mutex_);
  connections_.erase(fd);
  if (AtLimit(address)) ForgetClosed();
  if (AtLimit(address)) {
    ++refused_;
    return false;
  }
  connections_[fd] = {.inode = status.st_ino, .address = address};
  ++accepted_;
  return true;
}

bool Acceptor::AtLimit(const std::string& address) const {
  if (static_cast<int>(connections_.size()) >= max_connections_) return true;
  return std::count_if(connections_.begin(), connections_.end(), [&](const auto& connection) {
           return connection.second.address == address;
         }) >= options_.max_connections_per_address;
}

void Acceptor::ForgetClosed() const {
  std::erase_if(connections_, [](const auto& connection) {
    // Whoever owns the descriptor may close it meanwhile. This only asks the kernel what it is now,
    // by a call in which the thread sanitizer sees no use of the descriptor.
    struct statx status {};
    return ::statx(connection.first, "", AT_EMPTY_PATH, STATX_INO, &status) != 0 ||
           status.stx_ino != connection.second.inode;
  });
}

Acceptor::Stats Acceptor::GetStats() const {
  MutexLock lock(mutex_);
  ForgetClosed();
  return {
      .open = static_cast<int>(connections_.size()), .accepted = accepted_, .refused = refused_};
}

}  // namespace vs
