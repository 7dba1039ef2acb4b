#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace vs {

// The head of a request.
struct HttpRequest {
  std::string method;  // "GET"
  std::string target;  // "/sequence/1?tab=2"
  std::vector<std::pair<std::string, std::string>> headers;
  // Of the body, as announced.
  uint64_t content_bytes = 0;
  bool keep_alive = true;

  // The value of the first header of this name, in lower case; empty when there is none.
  std::string_view Header(std::string_view name) const;
};

using HttpHeaders = std::vector<std::pair<std::string_view, std::string>>;

struct HttpResponse {
  int status = 200;
  HttpHeaders headers;
  std::shared_ptr<const std::string> body;  // none: empty
};

// An answer of one line for whoever is not a browser's page.
HttpResponse PlainAnswer(int status, std::string text);

// The head of an answer: its own headers and those that tell the browser what our pages may do.
std::string ResponseHead(int status, const HttpHeaders& headers, bool keep_alive);

}  // namespace vs
