#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include <tl/expected.hpp>

#include "engine/base/deadline.h"
#include "server/http/client_stream.h"
#include "server/http/http_message.h"

namespace vs {

// Reads the requests of one connection in turn. Boost.Beast, which parses their heads, is known to
// its source only.
class RequestReader {
 public:
  // `stream` must outlive it. A head has at most `max_head_bytes`.
  RequestReader(ClientStream& stream, size_t max_head_bytes);
  ~RequestReader();
  RequestReader(const RequestReader&) = delete;
  RequestReader& operator=(const RequestReader&) = delete;

  // Waits for the first byte of the next request; false when none comes.
  bool AwaitRequest(const Deadline& deadline);
  // What is wrong with a request is the answer to it; nothing when the client has gone. After
  // either, the connection cannot be used any more.
  tl::expected<HttpRequest, std::optional<HttpResponse>> ReadHead(const Deadline& deadline);
  // The next `size` bytes; nothing when they do not come. Memory grows with what has come.
  std::optional<std::string> ReadBody(size_t size, const Deadline& deadline);

 private:
  struct Buffer;

  ClientStream& stream_;
  const size_t max_head_bytes_;
  const std::unique_ptr<Buffer> buffer_;  // what was read beyond the last request
};

}  // namespace vs
