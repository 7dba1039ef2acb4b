#include "tests/server/http/web_client.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <openssl/evp.h>
#include <openssl/ssl.h>
#include <openssl/x509.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <csignal>
#include <cstdio>
#include <stdexcept>
#include <utility>

namespace vs::test {
namespace {

constexpr int kPatienceMs = 60'000;

std::string ToLower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

}  // namespace

WebClient::WebClient(uint16_t port, Tls tls)
    : fd_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)),
      context_(nullptr, SSL_CTX_free),
      tls_(nullptr, SSL_free) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (fd_ < 0 || ::connect(fd_, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0) {
    throw std::runtime_error("cannot connect");
  }
  if (tls == Tls::kOff) return;
  std::signal(SIGPIPE, SIG_IGN);  // OpenSSL writes without asking for an error in its place
  context_.reset(SSL_CTX_new(TLS_client_method()));
  tls_.reset(SSL_new(context_.get()));
  SSL_set_fd(tls_.get(), fd_);
  if (SSL_connect(tls_.get()) != 1) throw std::runtime_error("no TLS");
}

WebClient::~WebClient() {
  tls_.reset();
  if (fd_ >= 0) ::close(fd_);
}

WebClient::WebClient(WebClient&& other) noexcept
    : fd_(std::exchange(other.fd_, -1)),
      context_(std::move(other.context_)),
      tls_(std::move(other.tls_)),
      received_(std::move(other.received_)) {}

bool WebClient::Send(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = tls_ ? SSL_write(tls_.get(), bytes.data(), static_cast<int>(bytes.size()))
                               : ::send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (count <= 0) return false;
    bytes.remove_prefix(static_cast<size_t>(count));
  }
  return true;
}

bool WebClient::ReadMore() {
  std::array<char, 64 << 10> buffer;  // NOLINT(*-member-init): read before it is used
  pollfd waiting = {fd_, POLLIN, 0};
  if ((!tls_ || SSL_pending(tls_.get()) == 0) && ::poll(&waiting, 1, kPatienceMs) <= 0) {
    throw std::runtime_error("nothing came for a minute");
  }
  const ssize_t count = tls_ ? SSL_read(tls_.get(), buffer.data(), static_cast<int>(buffer.size()))
                             : ::recv(fd_, buffer.data(), buffer.size(), 0);
  if (count <= 0) return false;
  received_.append(buffer.data(), static_cast<size_t>(count));
  return true;
}

std::optional<std::string> WebClient::ReadLine() {
  size_t end = 0;
  while ((end = received_.find("\r\n")) == std::string::npos) {
    if (!ReadMore()) return std::nullopt;
  }
  std::string line = received_.substr(0, end);
  received_.erase(0, end + 2);
  return line;
}

std::optional<std::string> WebClient::ReadBytes(size_t size) {
  while (received_.size() < size) {
    if (!ReadMore()) return std::nullopt;
  }
  std::string bytes = received_.substr(0, size);
  received_.erase(0, size);
  return bytes;
}

std::optional<WebAnswer> WebClient::ReceiveHead() {
  const std::optional<std::string> first = ReadLine();
  if (!first || !first->starts_with("HTTP/1.1 ")) return std::nullopt;
  WebAnswer answer{.status = std::stoi(first->substr(9, 3))};
  while (true) {
    const std::optional<std::string> line = ReadLine();
    if (!line) return std::nullopt;
    if (line->empty()) return answer;
    const size_t colon = line->find(": ");
    answer.headers[ToLower(line->substr(0, colon))] = line->substr(colon + 2);
  }
}

std::optional<std::string> WebClient::ReceiveChunk() {
  const std::optional<std::string> size = ReadLine();
  if (!size) return std::nullopt;
  std::optional<std::string> chunk = ReadBytes(std::stoul(*size, nullptr, 16));
  if (!ReadLine() || chunk == "") return std::nullopt;
  return chunk;
}

std::optional<WebAnswer> WebClient::Receive(bool has_body) {
  std::optional<WebAnswer> answer = ReceiveHead();
  if (!answer || !has_body) return answer;
  if (answer->headers.contains("transfer-encoding")) {
    while (const std::optional<std::string> chunk = ReceiveChunk()) answer->body += *chunk;
  } else if (answer->headers.contains("content-length")) {
    const auto body = ReadBytes(std::stoul(answer->headers["content-length"]));
    if (!body) return std::nullopt;
    answer->body = *body;
  }
  return answer;
}

std::optional<std::string> WebClient::ReceiveToEnd() {
  try {
    while (ReadMore()) {
    }
  } catch (const std::runtime_error&) {
    return std::nullopt;
  }
  return std::exchange(received_, "");
}

std::string WebClient::Fingerprint() const {
  const std::unique_ptr<X509, void (*)(X509*)> certificate(SSL_get1_peer_certificate(tls_.get()),
                                                           X509_free);
  std::array<unsigned char, 32> digest{};
  X509_digest(certificate.get(), EVP_sha256(), digest.data(), nullptr);
  std::string text;
  for (const unsigned char byte : digest) {
    std::array<char, 4> hex{};
    std::snprintf(hex.data(), hex.size(), "%s%02X", text.empty() ? "" : ":", byte);
    text += hex.data();
  }
  return text;
}

std::string WebRequest(std::string_view method, std::string_view target,
                       const WebHeaders& headers) {
  std::string request = std::string(method) + " " + std::string(target) + " HTTP/1.1\r\n";
  const auto is_host = [](const auto& header) { return ToLower(header.first) == "host"; };
  if (std::none_of(headers.begin(), headers.end(), is_host)) request += "Host: vision.example\r\n";
  for (const auto& [name, value] : headers) {
    request.append(name).append(": ").append(value).append("\r\n");
  }
  return request + "\r\n";
}

std::string WebPostBody(std::string_view method, std::string_view body, const WebHeaders& headers) {
  WebHeaders all = {{"Content-Type", "application/grpc-web+proto"},
                    {"Content-Length", std::to_string(body.size())}};
  all.insert(all.end(), headers.begin(), headers.end());
  return WebRequest("POST", method, all) + std::string(body);
}

std::string WebPost(std::string_view method, std::string_view message, const WebHeaders& headers) {
  std::string body(1, '\0');
  for (const int shift : {24, 16, 8, 0}) {
    body += static_cast<char>((message.size() >> static_cast<unsigned>(shift)) & 0xffU);
  }
  WebHeaders all = {{"Authorization", "Bearer good"}};
  all.insert(all.end(), headers.begin(), headers.end());
  return WebPostBody(method, body.append(message), all);
}

WebFrames FramesOf(std::string_view body) {
  WebFrames frames;
  while (body.size() >= 5) {
    size_t size = 0;
    for (int i = 1; i <= 4; ++i) size = size << 8U | static_cast<unsigned char>(body[i]);
    const bool trailers = static_cast<unsigned char>(body[0]) == 0x80;
    std::string content(body.substr(5, size));
    body.remove_prefix(std::min(body.size(), 5 + size));
    if (!trailers) {
      frames.messages.push_back(std::move(content));
      continue;
    }
    for (size_t begin = 0, end = 0; (end = content.find("\r\n", begin)) != std::string::npos;
         begin = end + 2) {
      const std::string line = content.substr(begin, end - begin);
      const size_t colon = line.find(": ");
      frames.trailers[line.substr(0, colon)] = line.substr(colon + 2);
    }
  }
  return frames;
}

}  // namespace vs::test
