#include "server/access/accounts.h"

#include <algorithm>
#include <cctype>
#include <utility>

#include "engine/base/log.h"
#include "engine/base/str.h"

namespace vs {
namespace {

constexpr const char* kFirstAdmin = "admin";
constexpr int64_t kOneTimeLifeNs = int64_t{24} * 3600 * 1'000'000'000;
constexpr size_t kMaxUsers = 10'000;
constexpr size_t kMaxApiKeys = 1'000;

bool IsUserName(const std::string& name) {
  return !name.empty() && name.size() <= 64 && name[0] >= 'a' && name[0] <= 'z' &&
         std::all_of(name.begin(), name.end(), [](char c) {
           return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '.' || c == '_' ||
                  c == '-';
         });
}

bool IsHumanRole(Role role) { return role >= Role::kViewer && role <= Role::kAdmin; }

bool IsAdministrator(const UserRecord& user) {
  return user.role == Role::kAdmin && !user.disabled;
}

Status CheckFullName(const std::string& full_name) {
  if (full_name.size() <= 128) return Status();
  return InvalidArgument(Str("the full name has ", full_name.size(), " bytes, at most 128 fit"));
}

Status NoSuchUser(const std::string& name) { return NotFound(Str("there is no user ", name)); }

}  // namespace

Result<std::unique_ptr<Accounts>> Accounts::Open(AccessDatabase& database,
                                                 const PasswordHasher& hasher, const Clock& clock) {
  std::unique_ptr<Accounts> accounts(new Accounts(database, hasher, clock));
  VS_RETURN_IF_ERROR(accounts->Load());
  return accounts;
}

Status Accounts::Load() {
  VS_ASSIGN_OR_RETURN(const std::vector<UserRecord> users, database_.Users());
  VS_ASSIGN_OR_RETURN(const std::vector<ApiKeyRecord> keys, database_.ApiKeys());
  MutexLock lock(mutex_);
  for (const UserRecord& user : users) users_[user.name] = user;
  for (const ApiKeyRecord& key : keys) keys_[key.secret_hash] = {.record = key};
  return Status();
}

std::string Accounts::Fold(const std::string& name) {
  std::string folded = name;
  std::transform(folded.begin(), folded.end(), folded.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return folded;
}

Result<std::optional<std::string>> Accounts::FirstPassword() {
  MutexLock changing(changes_);
  const std::vector<UserRecord> users = Users();
  const bool nobody_yet =
      users.empty() || (users.size() == 1 && users[0].name == kFirstAdmin &&
                        users[0].must_change_password && users[0].last_login_utc_ns == 0);
  if (!nobody_yet) return std::optional<std::string>();
  UserRecord admin{.name = kFirstAdmin, .role = Role::kAdmin, .created_utc_ns = clock_.UtcNs()};
  if (!users.empty()) admin = users[0];
  VS_ASSIGN_OR_RETURN(const std::string password, GiveOneTimePassword(std::move(admin)));
  return std::optional<std::string>(password);
}

Result<std::string> Accounts::RescueAdmin() {
  MutexLock changing(changes_);
  UserRecord admin =
      FindUser(kFirstAdmin)
          .value_or(UserRecord{.name = kFirstAdmin, .created_utc_ns = clock_.UtcNs()});
  admin.role = Role::kAdmin;
  admin.disabled = false;
  return GiveOneTimePassword(std::move(admin));
}

std::optional<UserRecord> Accounts::FindUser(const std::string& name) const {
  MutexLock lock(mutex_);
  const auto found = users_.find(Fold(name));
  if (found == users_.end()) return std::nullopt;
  return found->second;
}

Result<UserRecord> Accounts::RequireUser(const std::string& name) const {
  const std::optional<UserRecord> user = FindUser(name);
  if (!user) return NoSuchUser(name);
  return *user;
}

std::vector<UserRecord> Accounts::Users() const {
  std::vector<UserRecord> all;
  MutexLock lock(mutex_);
  for (const auto& [name, user] : users_) all.push_back(user);
  return all;
}

Result<std::string> Accounts::CreateUser(const UserRecord& user) {
  MutexLock changing(changes_);
  const std::string name = Fold(user.name);
  if (!IsUserName(name)) {
    return InvalidArgument(Str("\"", user.name, "\" is not a user name: take 1 to 64 of a-z, 0-9,",
                               " dot, underscore and hyphen, beginning with a letter"));
  }
  if (!IsHumanRole(user.role)) {
    return InvalidArgument("a user is viewer, operator, engineer or admin; robots have API keys");
  }
  VS_RETURN_IF_ERROR(CheckFullName(user.full_name));
  if (FindUser(name)) return AlreadyExists(Str("there is a user ", name, " already"));
  if (Users().size() >= kMaxUsers) {
    return ResourceExhausted(Str("there are ", kMaxUsers, " users, which is the limit"));
  }
  return GiveOneTimePassword({.name = name,
                              .full_name = user.full_name,
                              .role = user.role,
                              .created_utc_ns = clock_.UtcNs()});
}

Result<UserRecord> Accounts::UpdateUser(const std::string& name, const UserChange& change,
                                        int64_t revision) {
  MutexLock changing(changes_);
  VS_ASSIGN_OR_RETURN(UserRecord user, RequireUser(name));
  if (revision != 0 && revision != user.revision) {
    return Aborted(Str("somebody else changed the user ", name, " meanwhile; read it again"));
  }
  const UserRecord before = user;
  if (change.full_name) {
    VS_RETURN_IF_ERROR(CheckFullName(*change.full_name));
    user.full_name = *change.full_name;
  }
  if (change.role) {
    if (!IsHumanRole(*change.role)) {
      return InvalidArgument("a user is viewer, operator, engineer or admin; robots have API keys");
    }
    user.role = *change.role;
  }
  if (change.disabled) user.disabled = *change.disabled;
  if (IsAdministrator(before) && !IsAdministrator(user)) {
    VS_RETURN_IF_ERROR(RequireOtherAdmin(user.name));
  }
  ++user.revision;
  VS_RETURN_IF_ERROR(Publish(user));
  return user;
}

Status Accounts::DeleteUser(const std::string& name) {
  MutexLock changing(changes_);
  VS_ASSIGN_OR_RETURN(const UserRecord user, RequireUser(name));
  if (IsAdministrator(user)) VS_RETURN_IF_ERROR(RequireOtherAdmin(user.name));
  VS_RETURN_IF_ERROR(database_.DeleteUser(user.name));
  MutexLock lock(mutex_);
  users_.erase(user.name);
  return Status();
}

Status Accounts::RequireOtherAdmin(const std::string& name) const {
  for (const UserRecord& user : Users()) {
    if (IsAdministrator(user) && user.name != name) return Status();
  }
  return FailedPrecondition("the server needs an administrator; make somebody else one first");
}

Result<std::string> Accounts::ResetPassword(const std::string& name) {
  MutexLock changing(changes_);
  VS_ASSIGN_OR_RETURN(UserRecord user, RequireUser(name));
  return GiveOneTimePassword(std::move(user));
}

Result<std::string> Accounts::GiveOneTimePassword(UserRecord user) {
  const std::string password = MakeOneTimePassword();
  VS_ASSIGN_OR_RETURN(user.password_hash, hasher_.Hash(password));
  user.must_change_password = true;
  user.one_time_used = false;
  user.one_time_until_utc_ns = clock_.UtcNs() + kOneTimeLifeNs;
  ++user.revision;
  VS_RETURN_IF_ERROR(Publish(std::move(user)));
  return password;
}

Status Accounts::Publish(UserRecord user) {
  VS_RETURN_IF_ERROR(database_.Save(user));
  MutexLock lock(mutex_);
  users_[user.name] = std::move(user);
  return Status();
}

Result<std::optional<UserRecord>> Accounts::LogIn(const std::string& name,
                                                  const std::string& password) {
  const std::optional<UserRecord> seen = FindUser(name);
  const bool fits = hasher_.Verify(seen ? seen->password_hash : std::string(), password);
  if (!seen || !fits) return std::optional<UserRecord>();
  // Hashing took long; changes meanwhile count.
  MutexLock changing(changes_);
  std::optional<UserRecord> user = FindUser(name);
  if (!user || user->disabled || user->password_hash != seen->password_hash) {
    return std::optional<UserRecord>();
  }
  if (user->must_change_password) {
    if (user->one_time_used || clock_.UtcNs() >= user->one_time_until_utc_ns) {
      return std::optional<UserRecord>();
    }
    user->one_time_used = true;
  } else if (hasher_.Outdated(user->password_hash)) {
    VS_ASSIGN_OR_RETURN(user->password_hash, hasher_.Hash(password));
  }
  user->last_login_utc_ns = clock_.UtcNs();
  VS_RETURN_IF_ERROR(Publish(*user));
  return user;
}

Status Accounts::ChangePassword(const std::string& name, const std::string& old_password,
                                const std::string& new_password) {
  VS_RETURN_IF_ERROR(CheckNewPassword(name, new_password));
  MutexLock changing(changes_);
  VS_ASSIGN_OR_RETURN(UserRecord user, RequireUser(name));
  if (!hasher_.Verify(user.password_hash, old_password)) {
    return PermissionDenied("the old password is wrong").WithReason("WRONG_PASSWORD");
  }
  if (old_password == new_password) {
    return InvalidArgument("the new password is the old one: take another");
  }
  VS_ASSIGN_OR_RETURN(user.password_hash, hasher_.Hash(new_password));
  user.must_change_password = false;
  user.one_time_used = false;
  user.one_time_until_utc_ns = 0;
  ++user.revision;
  return Publish(std::move(user));
}

bool Accounts::Ended(const ApiKeyRecord& key) const {
  return key.expires_utc_ns != 0 && clock_.UtcNs() >= key.expires_utc_ns;
}

std::optional<ApiKeyRecord> Accounts::FindApiKey(const TokenHash& secret_hash) {
  MutexLock lock(mutex_);
  const auto found = keys_.find(secret_hash);
  if (found == keys_.end() || Ended(found->second.record)) return std::nullopt;
  found->second.last_used_utc_ns = clock_.UtcNs();
  return found->second.record;
}

std::optional<ApiKeyRecord> Accounts::FindApiKeyById(const std::string& id) const {
  MutexLock lock(mutex_);
  for (const auto& [hash, key] : keys_) {
    if (key.record.id == id && !Ended(key.record)) return key.record;
  }
  return std::nullopt;
}

std::vector<Accounts::ApiKeyInfo> Accounts::ApiKeys() const {
  std::vector<ApiKeyInfo> all;
  {
    MutexLock lock(mutex_);
    for (const auto& [hash, key] : keys_) all.push_back(key);
  }
  std::sort(all.begin(), all.end(),
            [](const ApiKeyInfo& a, const ApiKeyInfo& b) { return a.record.name < b.record.name; });
  return all;
}

Result<Accounts::NewApiKey> Accounts::CreateApiKey(const ApiKeyRecord& wanted) {
  MutexLock changing(changes_);
  if (wanted.name.empty() || wanted.name.size() > 64) {
    return InvalidArgument("an API key needs a name of 1 to 64 bytes, such as \"robot cell 7\"");
  }
  if (wanted.role != Role::kRobot && wanted.role != Role::kViewer) {
    return InvalidArgument("an API key has the role robot, or viewer to read only");
  }
  if (Ended(wanted)) return InvalidArgument("the API key would have ended already");
  const std::vector<ApiKeyInfo> keys = ApiKeys();
  if (std::any_of(keys.begin(), keys.end(),
                  [&](const ApiKeyInfo& key) { return key.record.name == wanted.name; })) {
    return AlreadyExists(Str("there is an API key \"", wanted.name, "\" already; revoke it first"));
  }
  if (keys.size() >= kMaxApiKeys) {
    return ResourceExhausted(Str("there are ", kMaxApiKeys, " API keys, which is the limit"));
  }
  NewApiKey made{.record = wanted, .secret = MakeToken("vsk_")};
  made.record.id = MakeId();
  made.record.secret_hash = HashToken(made.secret);
  made.record.created_utc_ns = clock_.UtcNs();
  VS_RETURN_IF_ERROR(database_.Save(made.record));
  MutexLock lock(mutex_);
  keys_[made.record.secret_hash] = {.record = made.record};
  return made;
}

Status Accounts::RevokeApiKey(const std::string& id) {
  MutexLock changing(changes_);
  {
    MutexLock lock(mutex_);
    const size_t removed =
        std::erase_if(keys_, [&](const auto& item) { return item.second.record.id == id; });
    if (removed == 0) return NotFound(Str("there is no API key ", id));
  }
  return database_.DeleteApiKey(id);
}

}  // namespace vs
