#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/mutex.h"
#include "engine/base/status.h"
#include "server/storage/sqlite.h"

namespace vs {

// One call that changed something, or tried to: see AuditEntry in audit.proto.
struct AuditEntry {
  uint64_t number = 0;  // order of storing, from 1, never used twice
  int64_t time_utc_ns = 0;
  std::string user;
  std::string address;
  std::string method;
  std::string subject;
  bool ok = false;
  std::string message;
  // Refused, and nobody knows to whom: anybody can make any number of these.
  bool by_stranger = false;
};

// How much is kept. What strangers did has a tenth of the entries for itself, so that they cannot
// push out what others did.
struct AuditLimits {
  int64_t keep_ns = int64_t{365} * 24 * 3600 * 1'000'000'000;
  int64_t keep_entries = 100'000;
};

// Which entries are meant; all conditions hold at once.
struct AuditFilter {
  std::string user;                 // empty = all; case does not matter
  std::string method;               // a part of the name; empty = all; case does not matter
  std::optional<int64_t> from_ns;   // at or after, UTC
  std::optional<int64_t> until_ns;  // before, UTC
};

// The file of the entries. Survives power cuts. Thread-safe; calls wait for each other and the
// disk.
class AuditStore {
 public:
  // Makes the file when there is none.
  static Result<std::unique_ptr<AuditStore>> Open(const std::filesystem::path& file);

  // All or none; their numbers do not matter.
  Status Append(const std::vector<AuditEntry>& entries) VS_EXCLUDES(mutex_);
  // Removes what is beyond the limits.
  Status Trim(const AuditLimits& limits, int64_t now_utc_ns) VS_EXCLUDES(mutex_);

  struct Page {
    std::vector<AuditEntry> entries;
    bool more = false;  // there are others behind them
  };
  // Newest first, those with a number below `before` (absent: from the newest on).
  Result<Page> List(const AuditFilter& filter, std::optional<uint64_t> before, size_t limit)
      VS_EXCLUDES(mutex_);

 private:
  explicit AuditStore(Database database) : database_(std::move(database)) {}

  Mutex mutex_;
  Database database_ VS_GUARDED_BY(mutex_);
};

}  // namespace vs
