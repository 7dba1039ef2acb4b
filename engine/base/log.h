#pragma once

#include <string>
#include <string_view>

namespace vs {

// ERROR: something was lost. WARN: it worked otherwise than asked. INFO: an operator wants to know.
// DEBUG: everything else; a line for each frame is never above DEBUG.
enum class LogLevel { kDebug, kInfo, kWarn, kError };

// Writes one line to standard error: time, level, component ("camera", "access"), text. Control
// characters in the text are escaped, so no input can forge a line. Never blocks on a slow reader
// for longer than the write itself; may be called from any thread.
void Log(LogLevel level, std::string_view component, std::string_view text);

inline void LogDebug(std::string_view component, std::string_view text) {
  Log(LogLevel::kDebug, component, text);
}
inline void LogInfo(std::string_view component, std::string_view text) {
  Log(LogLevel::kInfo, component, text);
}
inline void LogWarn(std::string_view component, std::string_view text) {
  Log(LogLevel::kWarn, component, text);
}
inline void LogError(std::string_view component, std::string_view text) {
  Log(LogLevel::kError, component, text);
}

// Lines below `level` are not written. INFO at start.
void SetLogLevel(LogLevel level);

}  // namespace vs
