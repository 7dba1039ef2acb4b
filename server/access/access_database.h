#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/mutex.h"
#include "engine/base/status.h"
#include "server/access/caller.h"
#include "server/access/token.h"
#include "server/storage/sqlite.h"

namespace vs {

// Times are nanoseconds since 1970 UTC; 0 = never.

struct UserRecord {
  std::string name;  // lower case, unique
  std::string full_name;
  Role role = Role::kViewer;
  std::string password_hash;
  bool disabled = false;
  // The password was made by the server: valid for one login until `one_time_until_utc_ns`, to be
  // changed then.
  bool must_change_password = false;
  bool one_time_used = false;
  int64_t one_time_until_utc_ns = 0;
  int64_t created_utc_ns = 0;
  int64_t last_login_utc_ns = 0;
  int64_t revision = 1;  // counts the changes
};

struct ApiKeyRecord {
  std::string id;
  TokenHash secret_hash{};
  std::string name;  // unique
  Role role = Role::kRobot;
  int64_t created_utc_ns = 0;
  std::string created_by;
  int64_t expires_utc_ns = 0;
};

struct SessionRecord {
  std::string id;
  TokenHash token_hash{};
  std::string user;
  std::string address;
  std::string client;
  int64_t created_utc_ns = 0;
  int64_t expires_utc_ns = 0;
  int64_t last_used_utc_ns = 0;  // as last stored
};

// The file of users, keys and login sessions. Survives power cuts; holds no password and no token,
// only hashes. Thread-safe; a change waits for the disk.
class AccessDatabase {
 public:
  // Makes the file, readable by its owner only, when there is none.
  static Result<std::unique_ptr<AccessDatabase>> Open(const std::filesystem::path& file);

  Result<std::vector<UserRecord>> Users();
  Result<std::vector<ApiKeyRecord>> ApiKeys();
  Result<std::vector<SessionRecord>> Sessions();

  // Adds it or puts it in the place of the one with the same name or id.
  Status Save(const UserRecord& user);
  Status Save(const ApiKeyRecord& key);
  Status Save(const SessionRecord& session);
  // Stores last_used_utc_ns of those sessions that are there.
  Status SaveLastUse(const std::vector<SessionRecord>& sessions);
  // Together with the user's sessions.
  Status DeleteUser(const std::string& name);
  Status DeleteApiKey(const std::string& id);
  Status DeleteSession(const std::string& id);

 private:
  explicit AccessDatabase(Database database) : database_(std::move(database)) {}
  Status Delete(std::string_view sql, const std::string& key) VS_REQUIRES(mutex_);

  Mutex mutex_;
  Database database_ VS_GUARDED_BY(mutex_);
};

}  // namespace vs
