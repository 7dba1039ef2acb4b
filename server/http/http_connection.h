#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <memory>
#include <string>
#include <thread>

#include "engine/base/clock.h"
#include "server/http/client_stream.h"
#include "server/http/http_message.h"
#include "server/http/request_reader.h"
#include "server/http/web_call.h"
#include "server/http/web_root.h"
#include "server/rpc/dispatcher.h"
#include "server/rpc/patience.h"
#include "server/transport/acceptor.h"

struct ssl_ctx_st;

namespace vs {

struct HttpLimits {
  // Of the request line and all headers.
  size_t head_bytes = size_t{8} << 10;
  // TLS must be set up by then.
  std::chrono::milliseconds handshake{5'000};
  // From the first byte of a request's head to its last; also for the first byte of a connection.
  std::chrono::milliseconds head{10'000};
  // Between two requests.
  std::chrono::milliseconds idle{60'000};
  // For a client to take a file. A page that comes slowly is better than none.
  Patience file{.silence = std::chrono::milliseconds(30'000)};
  WebCallLimits calls;
};

// What all connections share. It outlives them.
struct HttpShared {
  const HttpLimits& limits;
  const WebRoot& root;
  Dispatcher& dispatcher;
  Acceptor* acceptor = nullptr;  // whence the connections come
  std::atomic<size_t> request_memory{0};
};

// One client's connection and its thread: answers requests in turn, with a file or with a call.
class HttpConnection {
 public:
  // `tls` is null for plain text.
  HttpConnection(int fd, std::string client_address, std::shared_ptr<ssl_ctx_st> tls,
                 HttpShared& shared);
  // Waits for the thread.
  ~HttpConnection() = default;
  HttpConnection(const HttpConnection&) = delete;
  HttpConnection& operator=(const HttpConnection&) = delete;

  // Takes no more requests: ends after the answer under way, and at once between two.
  void StopReading() { stream_.StopReading(); }
  // Breaks off what is under way.
  void Cut() { stream_.Cut(); }
  bool done() const { return done_; }

 private:
  void Run();
  // True: through TLS, if that is wanted.
  bool SetUp();
  // To a browser that was told http:// where it is https://.
  void PointToTls();
  // True: the connection can take another request.
  bool AnswerNext(std::chrono::milliseconds patience);
  bool AnswerPost(const HttpRequest& request);
  bool Send(const HttpRequest& request, const HttpResponse& response);
  void SendLast(const HttpResponse& response);

  const std::string client_address_;
  const std::shared_ptr<ssl_ctx_st> tls_;
  HttpShared& shared_;
  const SystemClock clock_;
  ClientStream stream_;
  RequestReader reader_;
  std::atomic<bool> done_{false};
  std::jthread thread_;  // last: it uses the others
};

}  // namespace vs
