#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

struct ssl_ctx_st;
struct ssl_st;

namespace vs::test {

// An answer as it came: header names in lower case, chunks joined.
struct WebAnswer {
  int status = 0;
  std::map<std::string, std::string> headers;
  std::string body;
};

// A connection to an HTTP port of this machine, plain or through TLS (with whatever certificate),
// for sending what no browser sends. Waits a minute for what must come.
class WebClient {
 public:
  enum class Tls { kOff, kOn };
  // Throws when nobody listens or TLS does not come about.
  WebClient(uint16_t port, Tls tls);
  ~WebClient();
  WebClient(WebClient&& other) noexcept;
  WebClient& operator=(WebClient&&) = delete;

  // False when the other side has closed.
  bool Send(std::string_view bytes);
  // The next answer, whole; nothing when the connection ends before.
  std::optional<WebAnswer> Receive(bool has_body = true);
  // Only the head of the next answer, then chunk by chunk; nothing after the last one.
  std::optional<WebAnswer> ReceiveHead();
  std::optional<std::string> ReceiveChunk();
  // Reads until the other side closes; all that came, or nothing when it does not close.
  std::optional<std::string> ReceiveToEnd();
  // Of the server's certificate, as CheckCertificate gives it.
  std::string Fingerprint() const;

 private:
  // False: the connection has ended.
  bool ReadMore();
  std::optional<std::string> ReadLine();
  std::optional<std::string> ReadBytes(size_t size);

  int fd_;
  std::unique_ptr<ssl_ctx_st, void (*)(ssl_ctx_st*)> context_;
  std::unique_ptr<ssl_st, void (*)(ssl_st*)> tls_;
  std::string received_;
};

using WebHeaders = std::vector<std::pair<std::string, std::string>>;

// "GET / HTTP/1.1" and its like, with a Host.
std::string WebRequest(std::string_view method, std::string_view target,
                       const WebHeaders& headers = {});
// A gRPC-Web request with the message in one frame.
std::string WebPost(std::string_view method, std::string_view message,
                    const WebHeaders& headers = {});
// The same with a body as it is.
std::string WebPostBody(std::string_view method, std::string_view body,
                        const WebHeaders& headers = {});

// The frames of a gRPC-Web body: its messages, and the lines of its trailers.
struct WebFrames {
  std::vector<std::string> messages;
  std::map<std::string, std::string> trailers;
};
WebFrames FramesOf(std::string_view body);

}  // namespace vs::test
