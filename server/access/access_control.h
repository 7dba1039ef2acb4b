#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "engine/base/clock.h"
#include "engine/base/status.h"
#include "server/access/access_database.h"
#include "server/access/accounts.h"
#include "server/access/login_throttle.h"
#include "server/access/password.h"
#include "server/access/sessions.h"
#include "server/rpc/gatekeeper.h"

namespace vs {

struct AccessOptions {
  std::filesystem::path database;  // made when there is none
  SessionLimits sessions;
  PasswordCost password_cost;
};

// The gate of the server: who calls, and may they? Thread-safe.
class AccessControl final : public Gatekeeper {
 public:
  // `clock` must outlive it.
  static Result<std::unique_ptr<AccessControl>> Open(const AccessOptions& options,
                                                     const Clock& clock);

  Result<Caller> Admit(const std::string& method, std::string_view credential) override;
  Caller Identify(std::string_view credential) override;
  Status Recheck(const std::string& method, const Caller& caller, bool in_use) override;

  // Turns away an address that has guessed too often, without hashing anything.
  Status AdmitLogin(const std::string& address) const { return throttle_.CheckAddress(address); }
  struct LoggedIn {
    std::string token;
    SessionRecord session;
    UserRecord user;
  };
  // UNAUTHENTICATED, the same for an unknown user and a wrong password; RESOURCE_EXHAUSTED while
  // the account is slowed down. Hashes: see Accounts.
  Result<LoggedIn> LogIn(const std::string& name, const std::string& password,
                         const std::string& address, const std::string& client);
  // Of the caller itself; ends the caller's other sessions.
  Status ChangePassword(const Caller& caller, const std::string& old_password,
                        const std::string& new_password, const std::string& address);

  // Until when failed logins keep this user out, in UTC; 0 when they do not.
  int64_t LockedUntilUtcNs(const std::string& user) const {
    return throttle_.LockedUntilUtcNs(user);
  }
  // NOT_FOUND. The password stays.
  Result<UserRecord> Unlock(const std::string& name);

  Accounts& accounts() { return *accounts_; }
  Sessions& sessions() { return *sessions_; }
  const PasswordHasher& hasher() const { return hasher_; }
  uint64_t logins() const { return logins_; }
  uint64_t failed_logins() const { return failed_logins_; }

 private:
  AccessControl(std::unique_ptr<AccessDatabase> database, const AccessOptions& options,
                const Clock& clock)
      : database_(std::move(database)), hasher_(options.password_cost), throttle_(clock) {}

  Caller OfSession(const std::optional<SessionRecord>& session) const;

  const std::unique_ptr<AccessDatabase> database_;
  const PasswordHasher hasher_;
  LoginThrottle throttle_;
  std::unique_ptr<Accounts> accounts_;
  std::unique_ptr<Sessions> sessions_;
  std::atomic<uint64_t> logins_{0};
  std::atomic<uint64_t> failed_logins_{0};
};

}  // namespace vs
