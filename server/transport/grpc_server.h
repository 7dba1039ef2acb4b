#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "engine/base/status.h"
#include "server/rpc/dispatcher.h"
#include "server/transport/acceptor.h"
#include "server/transport/certificate.h"

namespace vs {

struct GrpcServerOptions {
  AcceptorOptions acceptor;
  // Absent: plain text, which only an address of this machine itself may have.
  std::optional<CertificateFiles> certificate;
  // A connection that is not through TLS and HTTP/2 set-up by then is closed.
  std::chrono::milliseconds handshake_timeout{5000};
  // A connection that is quiet for so long is asked for a sign of life, and closed when none comes
  // within half that time.
  std::chrono::milliseconds keepalive{10'000};
  int max_streams_per_connection = 100;
  int max_receive_bytes = 4 << 20;
  int max_metadata_bytes = 8 << 10;
  // Memory that all connections together may take for what they receive.
  size_t memory_bytes = size_t{512} << 20;
};

// How often clients may ask a server that asks them every `keepalive` for a sign of life: our own
// do so every ten seconds. gRPC hangs up on a client that asks more often.
std::chrono::milliseconds ShortestPingInterval(std::chrono::milliseconds keepalive);

// gRPC on a TCP port. Every call of every service goes to the dispatcher, through one generic
// entry.
class GrpcServer {
 public:
  // Bound to its port when it returns, but takes no connections before TakeConnections.
  // `dispatcher` must outlive it. A changed certificate file is used for new connections within a
  // second or two.
  static Result<std::unique_ptr<GrpcServer>> Start(const GrpcServerOptions& options,
                                                   Dispatcher& dispatcher);
  ~GrpcServer();
  GrpcServer(const GrpcServer&) = delete;
  GrpcServer& operator=(const GrpcServer&) = delete;

  void TakeConnections();
  uint16_t port() const;
  Acceptor::Stats Connections() const;

  // Accepts no more connections, lets running calls end until the deadline, then cuts them off.
  // Returns when the last call is gone.
  void Stop(std::chrono::milliseconds patience);

 private:
  class Impl;
  explicit GrpcServer(std::unique_ptr<Impl> impl);

  std::unique_ptr<Impl> impl_;
};

}  // namespace vs
