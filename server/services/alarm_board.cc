#include "server/services/alarm_board.h"

#include <algorithm>

#include "engine/base/log.h"
#include "engine/base/str.h"

namespace vs {

void AlarmBoard::Raise(const std::string& id, Severity severity, const std::string& message) {
  {
    MutexLock lock(mutex_);
    const auto [alarm, is_new] =
        alarms_.try_emplace(id, Alarm{.id = id, .since_utc_ns = clock_.UtcNs()});
    alarm->second.severity = severity;
    alarm->second.message = message;
    if (!is_new) return;
  }
  Log(severity == Severity::kError ? LogLevel::kError : LogLevel::kWarn, "alarm",
      Str(id, ": ", message));
}

void AlarmBoard::Clear(const std::string& id) {
  {
    MutexLock lock(mutex_);
    if (alarms_.erase(id) == 0) return;
  }
  LogInfo("alarm", Str(id, ": over"));
}

std::vector<AlarmBoard::Alarm> AlarmBoard::List() const {
  std::vector<Alarm> all;
  {
    MutexLock lock(mutex_);
    for (const auto& [id, alarm] : alarms_) all.push_back(alarm);
  }
  std::sort(all.begin(), all.end(), [](const Alarm& a, const Alarm& b) {
    if (a.severity != b.severity) return a.severity > b.severity;
    return a.since_utc_ns < b.since_utc_ns;
  });
  return all;
}

}  // namespace vs
