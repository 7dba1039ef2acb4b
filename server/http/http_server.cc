#include "server/http/http_server.h"

#include <unistd.h>

#include <algorithm>
#include <system_error>
#include <thread>
#include <utility>

#include "engine/base/log.h"
#include "engine/base/str.h"

namespace vs {

Result<std::unique_ptr<HttpServer>> HttpServer::Start(const HttpServerOptions& options,
                                                      Dispatcher& dispatcher) {
  const ListenAddress& address = options.acceptor.address;
  if (!options.certificate && !address.IsLoopback()) {
    return FailedPrecondition(
        Str("plain text on ", address.ToString(),
            " would let everybody on the network read passwords: use TLS, or 127.0.0.1"));
  }
  std::unique_ptr<HttpServer> server(new HttpServer(options, dispatcher));
  if (options.certificate) {
    VS_ASSIGN_OR_RETURN(server->tls_, TlsContext::Load(*options.certificate));
  }
  VS_ASSIGN_OR_RETURN(server->acceptor_, Acceptor::Listen(options.acceptor));
  server->shared_.acceptor = server->acceptor_.get();
  return server;
}

HttpServer::HttpServer(const HttpServerOptions& options, Dispatcher& dispatcher)
    : options_(options),
      root_(WebRoot::Load(options.web_root)),
      shared_{.limits = options_.limits, .root = root_, .dispatcher = dispatcher} {}

HttpServer::~HttpServer() { Stop(std::chrono::milliseconds(0)); }

void HttpServer::TakeConnections() {
  acceptor_->Start([this](int fd, const std::string& address) { Take(fd, address); });
}

void HttpServer::Take(int fd, const std::string& address) {
  MutexLock lock(mutex_);
  connections_.remove_if([](const HttpConnection& connection) { return connection.done(); });
  try {
    connections_.emplace_back(fd, address, tls_ ? tls_->Current() : nullptr, shared_);
  } catch (const std::system_error& error) {  // no thread; the connection is closed by now
    LogWarn("http", Str("turned ", address, " away: ", error.what()));
  }
}

bool HttpServer::AllDone() {
  MutexLock lock(mutex_);
  return std::all_of(connections_.begin(), connections_.end(),
                     [](const HttpConnection& connection) { return connection.done(); });
}

void HttpServer::Stop(std::chrono::milliseconds patience) {
  if (acceptor_) acceptor_->Stop();
  const Deadline deadline(clock_, patience);
  {
    MutexLock lock(mutex_);
    for (HttpConnection& connection : connections_) connection.StopReading();
  }
  while (!AllDone() && !deadline.Passed()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  MutexLock lock(mutex_);
  for (HttpConnection& connection : connections_) connection.Cut();
  connections_.clear();
}

}  // namespace vs
