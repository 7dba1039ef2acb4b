#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <thread>

#include "engine/base/mutex.h"
#include "engine/base/status.h"
#include "server/transport/listen_address.h"

namespace vs {

struct AcceptorOptions {
  ListenAddress address;
  int max_connections = 1024;
  int max_connections_per_address = 64;
  // A client that is quiet for so long is asked by TCP for a sign of life, rounded up to seconds.
  // 0: not asked, because who takes the connections does it.
  std::chrono::milliseconds keepalive{0};
  // One that was asked or sent something and has acknowledged nothing for so long has vanished: its
  // connection fails. Also one whose buffers stay full, so it is longer than anybody may be silent.
  std::chrono::milliseconds vanished{60'000};
};

// Listens on a TCP port and hands on each connection that the limits allow.
//
// gRPC's own accept loop goes deaf for ever when the process runs out of file descriptors
// (CVE-2023-4785, unfixed in the packaged 1.51). This one keeps a descriptor in reserve with which
// it turns connections away, and stops well before the limit. Thread-safe.
class Acceptor {
 public:
  // Bound and listening when it returns, so that connections wait for Start.
  static Result<std::unique_ptr<Acceptor>> Listen(const AcceptorOptions& options);
  ~Acceptor();
  Acceptor(const Acceptor&) = delete;
  Acceptor& operator=(const Acceptor&) = delete;

  // Calls `take` on a thread of its own for each connection; `take` owns the descriptor then.
  // `address`: of the client, no port.
  using Take = std::function<void(int fd, const std::string& address)>;
  void Start(Take take);
  // Whoever closes a connection may say so just before: it counts no longer then. The others are
  // found out.
  void Forget(int fd) VS_EXCLUDES(mutex_);
  // Accepts no more; `take` is not called any more when it returns.
  void Stop();

  uint16_t port() const { return port_; }

  struct Stats {
    int open = 0;
    uint64_t accepted = 0;
    uint64_t refused = 0;  // because of a limit
  };
  Stats GetStats() const;

 private:
  // gRPC closes descriptors without telling us. The inode number of a socket is unique among those
  // open, so it tells whether the descriptor is still that connection.
  struct Connection {
    ino_t inode = 0;
    std::string address;
  };

  Acceptor(const AcceptorOptions& options, int listener, int stop_event, uint16_t port);
  void Run();
  void AcceptOne();
  void TurnOneAway();
  // False: a limit is reached.
  bool Admit(int fd, const std::string& address) VS_EXCLUDES(mutex_);
  void ForgetClosed() const VS_REQUIRES(mutex_);
  bool AtLimit(const std::string& address) const VS_REQUIRES(mutex_);

  const AcceptorOptions options_;
  const int max_connections_;  // as the limit of open files allows
  const int listener_;
  const int stop_event_;
  const uint16_t port_;
  int reserve_;
  Take take_;
  mutable Mutex mutex_;
  mutable std::map<int, Connection> connections_ VS_GUARDED_BY(mutex_);
  uint64_t accepted_ VS_GUARDED_BY(mutex_) = 0;
  uint64_t refused_ VS_GUARDED_BY(mutex_) = 0;
  std::jthread thread_;
};

}  // namespace vs
