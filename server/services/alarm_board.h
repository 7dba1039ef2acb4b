#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "engine/base/clock.h"
#include "engine/base/mutex.h"

namespace vs {

// What needs attention now. Whoever notices it raises an alarm and clears it when it is over.
// Thread-safe.
class AlarmBoard {
 public:
  enum class Severity {
    kWarning = 1,  // works otherwise than asked
    kError = 2,    // something is lost
  };
  struct Alarm {
    std::string id;  // "camera/left", "disk"
    Severity severity = Severity::kWarning;
    std::string message;  // what is wrong and what to do
    int64_t since_utc_ns = 0;
  };

  explicit AlarmBoard(const Clock& clock) : clock_(clock) {}

  // Logs it when it is new; the same id again only changes the text.
  void Raise(const std::string& id, Severity severity, const std::string& message);
  void Clear(const std::string& id);
  // Gravest first, then oldest.
  std::vector<Alarm> List() const;

 private:
  const Clock& clock_;
  mutable Mutex mutex_;
  std::map<std::string, Alarm> alarms_ VS_GUARDED_BY(mutex_);
};

}  // namespace vs
