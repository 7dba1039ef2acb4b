#pragma once

#include <sstream>
#include <string>

namespace vs {

// Joins its arguments into one string: Str("width ", 3, " px"). For messages, not for hot loops.
template <class... Parts>
std::string Str(const Parts&... parts) {
  std::ostringstream text;
  (text << ... << parts);
  return text.str();
}

}  // namespace vs
