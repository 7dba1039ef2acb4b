#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <list>
#include <memory>
#include <optional>
#include <string>

#include "engine/base/clock.h"
#include "engine/base/mutex.h"
#include "engine/base/status.h"
#include "server/http/http_connection.h"
#include "server/http/tls_context.h"
#include "server/http/web_root.h"
#include "server/rpc/dispatcher.h"
#include "server/transport/acceptor.h"
#include "server/transport/certificate.h"

namespace vs {

struct HttpServerOptions {
  AcceptorOptions acceptor{.max_connections = 256,
                           .max_connections_per_address = 32,
                           .keepalive = std::chrono::seconds(10)};
  // Absent: plain text, which only an address of this machine itself may have.
  std::optional<CertificateFiles> certificate;
  // Folder of the page's files; see WebRoot.
  std::filesystem::path web_root;
  HttpLimits limits;
};

// The page and its calls on a TCP port: files by GET, and every method of every service by
// gRPC-Web. Calls go to the same dispatcher as those of gRPC. A thread for each connection.
class HttpServer {
 public:
  // Bound to its port when it returns, but takes no connections before TakeConnections.
  // `dispatcher` must outlive it. A changed certificate file is used for new connections within a
  // second or two.
  static Result<std::unique_ptr<HttpServer>> Start(const HttpServerOptions& options,
                                                   Dispatcher& dispatcher);
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  void TakeConnections();
  uint16_t port() const { return acceptor_->port(); }
  Acceptor::Stats Connections() const { return acceptor_->GetStats(); }
  // Whether the page itself is there, or only a notice that it is missing.
  bool HasPage() const { return root_.HasPage(); }

  // Accepts no more connections, lets answers under way end until then, then cuts them off. Returns
  // when the last thread has ended; before that, the dispatcher must let go of its calls.
  void Stop(std::chrono::milliseconds patience);

 private:
  HttpServer(const HttpServerOptions& options, Dispatcher& dispatcher);
  void Take(int fd, const std::string& address) VS_EXCLUDES(mutex_);
  bool AllDone() VS_EXCLUDES(mutex_);

  const HttpServerOptions options_;
  const SystemClock clock_;
  const WebRoot root_;
  HttpShared shared_;
  std::unique_ptr<TlsContext> tls_;  // null: plain text
  Mutex mutex_;
  std::list<HttpConnection> connections_ VS_GUARDED_BY(mutex_);
  std::unique_ptr<Acceptor> acceptor_;  // last: it feeds the others
};

}  // namespace vs
