#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "engine/base/clock.h"
#include "engine/base/mutex.h"
#include "engine/base/status.h"
#include "server/access/access_database.h"

namespace vs {

struct SessionLimits {
  int64_t idle_ns = int64_t{30} * 60 * 1'000'000'000;        // without a call
  int64_t lifetime_ns = int64_t{12} * 3600 * 1'000'000'000;  // however much it is used
  size_t per_user = 16;  // one more login ends the one unused for longest
  size_t total = 256;
};

// A login session as its owner and administrators see it. Times in UTC.
struct SessionInfo {
  SessionRecord record;
  int64_t last_used_utc_ns = 0;
};

// The login sessions. They live in memory, measured by the clock that never jumps, and on disk, so
// that a restart of the server logs nobody out. Thread-safe; looking one up never waits for the
// disk.
class Sessions {
 public:
  // `database` and `clock` must outlive it.
  static Result<std::unique_ptr<Sessions>> Open(AccessDatabase& database, const Clock& clock,
                                                const SessionLimits& limits);
  // Stores the last uses.
  ~Sessions();

  struct Created {
    std::string token;  // the secret, known to nobody else
    SessionRecord record;
  };
  // RESOURCE_EXHAUSTED when the server has as many sessions as it takes.
  Result<Created> Create(const std::string& user, const std::string& address,
                         const std::string& client);

  // The session with this token, which counts as used now; nothing when there is none or it has
  // ended.
  std::optional<SessionRecord> Find(const TokenHash& token_hash);
  // By its id. `in_use`: counts as used now.
  std::optional<SessionRecord> FindById(const std::string& id, bool in_use);

  // NOT_FOUND; `user` empty: anybody's.
  Status Remove(const std::string& id, const std::string& user);
  // All of a user, except perhaps one.
  Status RemoveOf(const std::string& user, const std::string& except_id = "");

  // Stores when each session was used last, for the next start of the server; to be called about
  // once a minute. What it has not stored counts as unused.
  Status StoreLastUse();

  // Newest first; `user` empty: everybody's.
  std::vector<SessionInfo> List(const std::string& user) const;
  size_t Count() const;
  const SessionLimits& limits() const { return limits_; }

 private:
  struct Entry {
    SessionRecord record;
    int64_t expires_ns = 0;     // monotonic
    int64_t last_used_ns = 0;   // monotonic
    int64_t stored_use_ns = 0;  // the last_used_ns that the disk knows
  };
  using Table = std::unordered_map<TokenHash, Entry, TokenHashHasher>;

  Sessions(AccessDatabase& database, const Clock& clock, const SessionLimits& limits)
      : database_(database), clock_(clock), limits_(limits) {}
  Status Load();
  bool Alive(const Entry& entry, int64_t now_ns) const;
  // Takes out what has ended, and what must go for a new session of `user`.
  std::vector<std::string> MakeRoomFor(const std::string& user) VS_REQUIRES(mutex_);
  Status DeleteAll(const std::vector<std::string>& ids);

  AccessDatabase& database_;
  const Clock& clock_;
  const SessionLimits limits_;
  mutable Mutex mutex_;
  Table sessions_ VS_GUARDED_BY(mutex_);
};

}  // namespace vs
