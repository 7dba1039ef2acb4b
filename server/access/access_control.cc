#include "server/access/access_control.h"

#include <utility>

#include "engine/base/log.h"
#include "engine/base/str.h"
#include "server/access/policy.h"

namespace vs {
namespace {

// Longer ones are not ours; hashing them would only cost time.
constexpr size_t kMaxCredentialBytes = 256;

Caller OfApiKey(const std::optional<ApiKeyRecord>& key) {
  if (!key) return Caller();
  return {.kind = Caller::Kind::kApiKey,
          .name = key->name,
          .role = key->role,
          .credential_id = key->id};
}

}  // namespace

Result<std::unique_ptr<AccessControl>> AccessControl::Open(const AccessOptions& options,
                                                           const Clock& clock) {
  VS_ASSIGN_OR_RETURN(std::unique_ptr<AccessDatabase> database,
                      AccessDatabase::Open(options.database));
  std::unique_ptr<AccessControl> access(new AccessControl(std::move(database), options, clock));
  VS_ASSIGN_OR_RETURN(access->accounts_,
                      Accounts::Open(*access->database_, access->hasher_, clock));
  VS_ASSIGN_OR_RETURN(access->sessions_,
                      Sessions::Open(*access->database_, clock, options.sessions));
  return access;
}

Caller AccessControl::Identify(std::string_view credential) {
  if (credential.empty() || credential.size() > kMaxCredentialBytes) return Caller();
  const TokenHash hash = HashToken(credential);
  if (const std::optional<SessionRecord> session = sessions_->Find(hash)) {
    return OfSession(session);
  }
  return OfApiKey(accounts_->FindApiKey(hash));
}

Caller AccessControl::OfSession(const std::optional<SessionRecord>& session) const {
  if (!session) return Caller();
  const std::optional<UserRecord> user = accounts_->FindUser(session->user);
  if (!user || user->disabled) return Caller();
  return {.kind = Caller::Kind::kUser,
          .name = user->name,
          .role = user->role,
          .credential_id = session->id,
          .must_change_password = user->must_change_password};
}

Result<Caller> AccessControl::Admit(const std::string& method, std::string_view credential) {
  const Caller caller = Identify(credential);
  VS_RETURN_IF_ERROR(CheckAccess(method, caller));
  return caller;
}

Status AccessControl::Recheck(const std::string& method, const Caller& caller, bool in_use) {
  Caller now;
  if (caller.kind == Caller::Kind::kUser) {
    now = OfSession(sessions_->FindById(caller.credential_id, in_use));
  } else if (caller.kind == Caller::Kind::kApiKey) {
    now = OfApiKey(accounts_->FindApiKeyById(caller.credential_id));
  }
  Status allowed = CheckAccess(method, now);
  if (allowed.code() == StatusCode::kUnauthenticated) {
    return Unauthenticated("the session has ended; log in again").WithReason("SESSION_ENDED");
  }
  return allowed;
}

Result<AccessControl::LoggedIn> AccessControl::LogIn(const std::string& name,
                                                     const std::string& password,
                                                     const std::string& address,
                                                     const std::string& client) {
  const std::string folded = Accounts::Fold(name);
  // Again, since others may have failed while this one waited for its turn.
  VS_RETURN_IF_ERROR(throttle_.CheckAddress(address));
  VS_RETURN_IF_ERROR(throttle_.CheckAccount(folded));
  VS_ASSIGN_OR_RETURN(const std::optional<UserRecord> user, accounts_->LogIn(folded, password));
  if (!user) {
    throttle_.Failed(folded, address);
    ++failed_logins_;
    LogInfo("access", Str("failed login of \"", name, "\" from ", address));
    return Unauthenticated("user name or password is wrong").WithReason("WRONG_CREDENTIALS");
  }
  throttle_.Forget(folded);
  VS_ASSIGN_OR_RETURN(Sessions::Created session, sessions_->Create(user->name, address, client));
  ++logins_;
  LogInfo("access", Str(user->name, " logged in from ", address));
  return LoggedIn{std::move(session.token), std::move(session.record), *user};
}

Status AccessControl::ChangePassword(const Caller& caller, const std::string& old_password,
                                     const std::string& new_password, const std::string& address) {
  if (caller.kind != Caller::Kind::kUser) {
    return FailedPrecondition("an API key has no password");
  }
  VS_RETURN_IF_ERROR(throttle_.CheckAccount(caller.name));
  const Status changed = accounts_->ChangePassword(caller.name, old_password, new_password);
  if (changed.reason() == "WRONG_PASSWORD") throttle_.Failed(caller.name, address);
  VS_RETURN_IF_ERROR(changed);
  LogInfo("access", Str(caller.name, " changed the password, from ", address));
  return sessions_->RemoveOf(caller.name, caller.credential_id);
}

Result<UserRecord> AccessControl::Unlock(const std::string& name) {
  std::optional<UserRecord> user = accounts_->FindUser(name);
  if (!user) return NotFound(Str("there is no user ", Quoted(name)));
  throttle_.Forget(user->name);
  return *std::move(user);
}

}  // namespace vs
