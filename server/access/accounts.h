#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "engine/base/clock.h"
#include "engine/base/mutex.h"
#include "engine/base/status.h"
#include "server/access/access_database.h"
#include "server/access/password.h"

namespace vs {

// Users and API keys: who there is, and with which secret. Thread-safe. Looking one up never waits;
// what takes a password hashes it and must run where that is allowed (Lane::kPassword).
class Accounts {
 public:
  // All three must outlive it.
  static Result<std::unique_ptr<Accounts>> Open(AccessDatabase& database,
                                                const PasswordHasher& hasher, const Clock& clock);

  // The one-time password of the user "admin" while nobody has logged in to this server yet, made
  // anew each time; nothing afterwards.
  Result<std::optional<std::string>> FirstPassword();
  // Gives the user "admin" (made if necessary, enabled, role admin) a new one-time password.
  Result<std::string> RescueAdmin();

  // Lower case, as names are stored and compared.
  static std::string Fold(const std::string& name);

  std::optional<UserRecord> FindUser(const std::string& name) const;
  // In the order of their names.
  std::vector<UserRecord> Users() const;
  // Gives the one-time password.
  Result<std::string> CreateUser(const UserRecord& user);
  struct UserChange {
    std::optional<std::string> full_name;
    std::optional<Role> role;
    std::optional<bool> disabled;
  };
  // ABORTED unless `revision` is 0 or the user's.
  Result<UserRecord> UpdateUser(const std::string& name, const UserChange& change,
                                int64_t revision);
  Status DeleteUser(const std::string& name);
  Result<std::string> ResetPassword(const std::string& name);

  // The user, when name and password fit and a login is allowed; nothing otherwise, after the same
  // work. A one-time password is used up by this.
  Result<std::optional<UserRecord>> LogIn(const std::string& name, const std::string& password);
  // PERMISSION_DENIED when the old one is wrong.
  Status ChangePassword(const std::string& name, const std::string& old_password,
                        const std::string& new_password);

  // The key with this secret; nothing when there is none or it has ended.
  std::optional<ApiKeyRecord> FindApiKey(const TokenHash& secret_hash);
  std::optional<ApiKeyRecord> FindApiKeyById(const std::string& id) const;
  struct ApiKeyInfo {
    ApiKeyRecord record;
    int64_t last_used_utc_ns = 0;  // 0: not since the server started
  };
  // In the order of their names.
  std::vector<ApiKeyInfo> ApiKeys() const;
  struct NewApiKey {
    ApiKeyRecord record;
    std::string secret;
  };
  Result<NewApiKey> CreateApiKey(const ApiKeyRecord& wanted);
  Status RevokeApiKey(const std::string& id);

 private:
  Accounts(AccessDatabase& database, const PasswordHasher& hasher, const Clock& clock)
      : database_(database), hasher_(hasher), clock_(clock) {}
  Status Load();
  // Stores `user` and shows it to everybody.
  Status Publish(UserRecord user) VS_REQUIRES(changes_);
  Result<std::string> GiveOneTimePassword(UserRecord user) VS_REQUIRES(changes_);
  Result<UserRecord> RequireUser(const std::string& name) const;
  // FAILED_PRECONDITION when no other administrator could log in.
  Status RequireOtherAdmin(const std::string& name) const;
  bool Ended(const ApiKeyRecord& key) const;

  AccessDatabase& database_;
  const PasswordHasher& hasher_;
  const Clock& clock_;
  // Held through a whole change, disk included; `mutex_` only while the tables are touched.
  Mutex changes_;
  mutable Mutex mutex_;
  std::map<std::string, UserRecord> users_ VS_GUARDED_BY(mutex_);
  std::unordered_map<TokenHash, ApiKeyInfo, TokenHashHasher> keys_ VS_GUARDED_BY(mutex_);
};

}  // namespace vs
