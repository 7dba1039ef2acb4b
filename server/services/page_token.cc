#include "server/services/page_token.h"

#include <charconv>

#include "engine/base/str.h"

namespace vs {

Result<std::optional<uint64_t>> ParsePageToken(const std::string& token) {
  if (token.empty()) return std::optional<uint64_t>();
  uint64_t number = 0;
  const char* end = token.data() + token.size();
  const auto parsed = std::from_chars(token.data(), end, number);
  if (parsed.ec != std::errc() || parsed.ptr != end) {
    return InvalidArgument(Str(Quoted(token), " is not a page_token of this method"));
  }
  return std::optional(number);
}

}  // namespace vs
