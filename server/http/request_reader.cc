#include "server/http/request_reader.h"

#include <algorithm>
#include <cctype>
#include <limits>
#include <utility>

#include <boost/asio/buffer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>

#include "engine/base/str.h"

namespace vs {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using beast::error_code;

constexpr size_t kReadBytes = 64 << 10;

// The stream as Beast wants to read from it, with the deadline of this head.
class TimedStream {
 public:
  TimedStream(ClientStream& stream, const Deadline& deadline)
      : stream_(stream), deadline_(deadline) {}

  template <class Buffers>
  size_t read_some(const Buffers& buffers, error_code& error) {  // NOLINT: Beast's name
    const asio::mutable_buffer first = *asio::buffer_sequence_begin(buffers);
    const size_t count = stream_.Read(first.data(), first.size(), deadline_);
    error = count > 0 ? error_code() : error_code(asio::error::eof);
    return count;
  }
  template <class Buffers>
  size_t read_some(const Buffers& buffers) {  // NOLINT: Beast's name
    error_code error;
    const size_t count = read_some(buffers, error);
    if (error) throw beast::system_error(error);
    return count;
  }

 private:
  ClientStream& stream_;
  const Deadline& deadline_;
};

std::string ToLower(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

std::string_view View(beast::string_view text) { return {text.data(), text.size()}; }

tl::unexpected<std::optional<HttpResponse>> Refuse(int status, std::string text) {
  return tl::make_unexpected(std::optional(PlainAnswer(status, std::move(text))));
}

}  // namespace

struct RequestReader::Buffer : beast::flat_buffer {
  using beast::flat_buffer::flat_buffer;
};

// Twice, so that the parser's own limit is met before the buffer is full.
RequestReader::RequestReader(ClientStream& stream, size_t max_head_bytes)
    : stream_(stream),
      max_head_bytes_(max_head_bytes),
      buffer_(std::make_unique<Buffer>(2 * max_head_bytes)) {}

RequestReader::~RequestReader() = default;

bool RequestReader::AwaitRequest(const Deadline& deadline) {
  return buffer_->size() > 0 || stream_.AwaitData(deadline);
}

tl::expected<HttpRequest, std::optional<HttpResponse>> RequestReader::ReadHead(
    const Deadline& deadline) {
  http::request_parser<http::empty_body> parser;
  parser.header_limit(static_cast<uint32_t>(max_head_bytes_));
  parser.body_limit(
      std::numeric_limits<uint64_t>::max());  // whoever reads the body knows its limit
  TimedStream stream(stream_, deadline);
  error_code error;
  http::read_header(stream, *buffer_, parser, error);
  if (error == http::error::header_limit || error == http::error::buffer_overflow) {
    return Refuse(431, Str("the head of a request may have ", max_head_bytes_, " bytes"));
  }
  if (error == http::error::end_of_stream || error == http::error::partial_message ||
      error == asio::error::eof) {
    if (!deadline.Passed()) return tl::make_unexpected(std::nullopt);
    return Refuse(408, "the head of the request did not come in time");
  }
  if (error) return Refuse(400, Str("not an HTTP request: ", error.message()));
  if (parser.get().version() != 11) return Refuse(505, "this server speaks HTTP/1.1 only");
  if (parser.chunked()) {
    return Refuse(411, "send the request with a Content-Length, not in chunks");
  }

  HttpRequest request{.method = std::string(View(parser.get().method_string())),
                      .target = std::string(View(parser.get().target())),
                      .content_bytes = parser.content_length().value_or(0),
                      .keep_alive = parser.keep_alive()};
  for (const auto& field : parser.get()) {
    request.headers.emplace_back(ToLower(View(field.name_string())), View(field.value()));
  }
  if (!request.target.starts_with('/')) {
    return Refuse(400,
                  Str("the target of a request begins with \"/\", not ", Quoted(request.target)));
  }
  return request;
}

std::optional<std::string> RequestReader::ReadBody(size_t size, const Deadline& deadline) {
  std::string body;
  const size_t buffered = std::min(size, buffer_->size());
  body.assign(static_cast<const char*>(buffer_->data().data()), buffered);
  buffer_->consume(buffered);
  while (body.size() < size) {
    const size_t begin = body.size();
    body.resize(std::min(size, begin + kReadBytes));
    const size_t count = stream_.Read(body.data() + begin, body.size() - begin, deadline);
    if (count == 0) return std::nullopt;
    body.resize(begin + count);
  }
  return body;
}

}  // namespace vs
