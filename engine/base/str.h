#pragma once

#include <sstream>
#include <string>
#include <string_view>

namespace vs {

// Joins its arguments into one string: Str("width ", 3, " px"). For messages, not for hot loops.
template <class... Parts>
std::string Str(const Parts&... parts) {
  std::ostringstream text;
  (text << ... << parts);
  return text.str();
}

// Somebody else's text as part of a message: in double quotes, cut after 60 characters ("..."),
// control characters and bytes that are not UTF-8 as \xNN. Always valid UTF-8.
std::string Quoted(std::string_view text);

}  // namespace vs
