#include "server/http/http_connection.h"

#include <pthread.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <utility>
#include <vector>

#include "engine/base/log.h"
#include "engine/base/str.h"
#include "server/http/grpc_web.h"

namespace vs {
namespace {

// Writing to a client that has gone is an error, not a signal; OpenSSL cannot ask for that itself.
void BlockBrokenPipeSignal() {
  sigset_t broken_pipe;
  sigemptyset(&broken_pipe);
  sigaddset(&broken_pipe, SIGPIPE);
  pthread_sigmask(SIG_BLOCK, &broken_pipe, nullptr);
}

bool EqualIgnoringCase(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&](char x, char y) { return lower(x) == lower(y); });
}

// A browser says from where the page comes that posts; other programs say nothing. The scheme may
// differ: a proxy may have taken TLS off.
bool ComesFromOwnPage(const HttpRequest& request) {
  std::string_view origin = request.Header("origin");
  if (origin.empty()) return true;
  const size_t scheme = origin.find("://");
  if (scheme == std::string_view::npos) return false;
  origin.remove_prefix(scheme + 3);
  return EqualIgnoringCase(origin, request.Header("host"));
}

bool IsHost(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
           std::string_view(".:-_[]").find(c) != std::string_view::npos;
  });
}

}  // namespace

HttpConnection::HttpConnection(int fd, std::string client_address, std::shared_ptr<ssl_ctx_st> tls,
                               HttpShared& shared)
    : client_address_(std::move(client_address)),
      tls_(std::move(tls)),
      shared_(shared),
      stream_(fd, clock_),
      reader_(stream_, shared.limits.head_bytes),
      thread_([this] { Run(); }) {}

void HttpConnection::Run() {
  BlockBrokenPipeSignal();
  try {
    if (SetUp()) {
      std::chrono::milliseconds patience = shared_.limits.head;
      while (AnswerNext(patience)) patience = shared_.limits.idle;
      stream_.CloseGently();
    }
  } catch (const std::exception& error) {  // no memory
    LogWarn("http", Str("lost the connection of ", client_address_, ": ", error.what()));
  }
  shared_.acceptor->Forget(stream_.fd());
  stream_.Close();
  done_ = true;
}

bool HttpConnection::SetUp() {
  if (!tls_) return true;
  const Deadline deadline(clock_, shared_.limits.handshake);
  const std::optional<char> first = stream_.Peek(deadline);
  if (!first) return false;
  if (*first >= 'A' && *first <= 'Z') {
    PointToTls();
    return false;
  }
  return stream_.StartTls(tls_.get(), deadline);
}

void HttpConnection::PointToTls() {
  const auto request = reader_.ReadHead(Deadline(clock_, shared_.limits.head));
  if (!request) return;
  HttpResponse response =
      PlainAnswer(400, "this port speaks TLS: use https:// in place of http://");
  const std::string_view host = request->Header("host");
  if (request->method == "GET" && IsHost(host)) {
    response.status = 307;
    response.headers.emplace_back("Location", Str("https://", host, request->target));
  }
  SendLast(response);
  stream_.CloseGently();
}

bool HttpConnection::AnswerNext(std::chrono::milliseconds patience) {
  if (!reader_.AwaitRequest(Deadline(clock_, patience))) return false;
  const auto request = reader_.ReadHead(Deadline(clock_, shared_.limits.head));
  if (!request) {
    if (request.error()) SendLast(*request.error());
    return false;
  }
  if (request->method == "POST") return AnswerPost(*request);
  if (request->method == "GET" || request->method == "HEAD") {
    return Send(*request, shared_.root.Answer(*request));
  }
  HttpResponse refusal = PlainAnswer(405, Str(Quoted(request->method), " is not done here"));
  refusal.headers.emplace_back("Allow", "GET, HEAD, POST");
  return Send(*request, refusal);
}

bool HttpConnection::AnswerPost(const HttpRequest& request) {
  if (!ComesFromOwnPage(request)) {
    return Send(request, PlainAnswer(403, Str("the page of ", Quoted(request.Header("origin")),
                                              " may not call this server")));
  }
  if (!IsGrpcWebType(request.Header("content-type"))) {
    return Send(request, PlainAnswer(415, Str("calls are taken as ", kGrpcWebType, ", not as ",
                                              Quoted(request.Header("content-type")))));
  }
  return WebCall(stream_, reader_, request, shared_.limits.calls, shared_.request_memory)
      .Run(shared_.dispatcher, client_address_);
}

bool HttpConnection::Send(const HttpRequest& request, const HttpResponse& response) {
  // A body that nobody wants would be taken for the next request.
  const bool keep_alive = request.keep_alive && request.content_bytes == 0;
  HttpHeaders headers = response.headers;
  const std::string_view body = response.body ? std::string_view(*response.body) : "";
  if (response.status != 304) headers.emplace_back("Content-Length", std::to_string(body.size()));
  const std::string head = ResponseHead(response.status, headers, keep_alive);
  const bool with_body = request.method != "HEAD";
  const std::array<std::string_view, 2> pieces = {head, with_body ? body : std::string_view()};
  return stream_.Write(pieces, shared_.limits.file) && keep_alive;
}

void HttpConnection::SendLast(const HttpResponse& response) {
  Send(HttpRequest{.method = "GET", .keep_alive = false}, response);
}

}  // namespace vs
