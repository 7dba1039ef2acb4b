#include "server/services/user_service.h"

#include <algorithm>
#include <charconv>
#include <map>
#include <string>

#include "engine/base/log.h"
#include "engine/base/str.h"
#include "server/convert/access.h"
#include "server/convert/time.h"

namespace vs {

namespace pb = visionserver::v1;

namespace {

// An empty etag is 0: whatever is there.
Result<int64_t> RevisionOf(const std::string& etag) {
  int64_t revision = 0;
  const char* end = etag.data() + etag.size();
  if (!etag.empty() && std::from_chars(etag.data(), end, revision).ptr != end) {
    return InvalidArgument(Str("\"", etag, "\" is not an etag of a user"));
  }
  return revision;
}

void Record(const Call& call, const std::string& what) {
  LogInfo("access", Str(call.caller.name, " ", what, ", from ", call.address));
}

}  // namespace

pb::User UserService::Shown(const UserRecord& user) const {
  return ToProto(user, access_.LockedUntilUtcNs(user.name));
}

void UserService::Register(Router& router) {
  const MethodOptions hashing = {.lane = Lane::kPassword, .max_request_bytes = 4096};
  const std::string prefix = "/visionserver.v1.UserService/";
  router.Unary(prefix + "ListUsers", this, &UserService::ListUsers);
  router.Unary(prefix + "CreateUser", this, &UserService::CreateUser, hashing);
  router.Unary(prefix + "UpdateUser", this, &UserService::UpdateUser);
  router.Unary(prefix + "DeleteUser", this, &UserService::DeleteUser);
  router.Unary(prefix + "ResetPassword", this, &UserService::ResetPassword, hashing);
  router.Unary(prefix + "UnlockUser", this, &UserService::UnlockUser);
  router.Unary(prefix + "ListSessions", this, &UserService::ListSessions);
  router.Unary(prefix + "CreateApiKey", this, &UserService::CreateApiKey);
  router.Unary(prefix + "ListApiKeys", this, &UserService::ListApiKeys);
  router.Unary(prefix + "RevokeApiKey", this, &UserService::RevokeApiKey);
}

Result<pb::ListUsersResponse> UserService::ListUsers(const Call& /*call*/,
                                                     const pb::ListUsersRequest& /*request*/) {
  pb::ListUsersResponse response;
  for (const UserRecord& user : access_.accounts().Users()) *response.add_users() = Shown(user);
  return response;
}

Result<pb::CreateUserResponse> UserService::CreateUser(const Call& call,
                                                       const pb::CreateUserRequest& request) {
  VS_ASSIGN_OR_RETURN(const Role role, FromProto(request.role()));
  VS_ASSIGN_OR_RETURN(
      const std::string password,
      access_.accounts().CreateUser(
          {.name = request.name(), .full_name = request.full_name(), .role = role}));
  Record(call, Str("created the user ", request.name(), " as ", RoleName(role)));
  pb::CreateUserResponse response;
  if (const auto user = access_.accounts().FindUser(request.name())) {
    *response.mutable_user() = Shown(*user);
  }
  response.set_one_time_password(password);
  return response;
}

Result<pb::User> UserService::UpdateUser(const Call& call, const pb::UpdateUserRequest& request) {
  Accounts::UserChange change;
  if (request.has_full_name()) change.full_name = request.full_name();
  if (request.has_disabled()) change.disabled = request.disabled();
  if (request.has_role()) {
    VS_ASSIGN_OR_RETURN(change.role, FromProto(request.role()));
  }
  VS_ASSIGN_OR_RETURN(const int64_t revision, RevisionOf(request.etag()));
  VS_ASSIGN_OR_RETURN(const UserRecord user,
                      access_.accounts().UpdateUser(request.name(), change, revision));
  Record(call, Str("changed the user ", user.name, ": ", RoleName(user.role),
                   user.disabled ? ", disabled" : ""));
  if (user.disabled) VS_RETURN_IF_ERROR(access_.sessions().RemoveOf(user.name));
  return Shown(user);
}

Result<pb::DeleteUserResponse> UserService::DeleteUser(const Call& call,
                                                       const pb::DeleteUserRequest& request) {
  VS_RETURN_IF_ERROR(access_.accounts().DeleteUser(request.name()));
  VS_RETURN_IF_ERROR(access_.sessions().RemoveOf(Accounts::Fold(request.name())));
  Record(call, Str("deleted the user ", request.name()));
  return pb::DeleteUserResponse();
}

Result<pb::ResetPasswordResponse> UserService::ResetPassword(
    const Call& call, const pb::ResetPasswordRequest& request) {
  VS_ASSIGN_OR_RETURN(const std::string password, access_.accounts().ResetPassword(request.name()));
  VS_RETURN_IF_ERROR(access_.sessions().RemoveOf(Accounts::Fold(request.name())));
  Record(call, Str("gave ", request.name(), " a one-time password"));
  pb::ResetPasswordResponse response;
  response.set_one_time_password(password);
  return response;
}

Result<pb::User> UserService::UnlockUser(const Call& call, const pb::UnlockUserRequest& request) {
  VS_ASSIGN_OR_RETURN(const UserRecord user, access_.Unlock(request.name()));
  Record(call, Str("unlocked the user ", user.name));
  return Shown(user);
}

Result<pb::ListSessionsResponse> UserService::ListSessions(const Call& call,
                                                           const pb::ListSessionsRequest& request) {
  std::map<std::string, Role> roles;
  for (const UserRecord& user : access_.accounts().Users()) roles[user.name] = user.role;
  pb::ListSessionsResponse response;
  for (const SessionInfo& session : access_.sessions().List(Accounts::Fold(request.user()))) {
    const auto role = roles.find(session.record.user);
    if (role == roles.end()) continue;  // deleted a moment ago
    *response.add_sessions() = ToProto(session, role->second, call.caller.credential_id);
  }
  return response;
}

Result<pb::CreateApiKeyResponse> UserService::CreateApiKey(const Call& call,
                                                           const pb::CreateApiKeyRequest& request) {
  ApiKeyRecord wanted{.name = request.name(), .created_by = call.caller.name};
  VS_ASSIGN_OR_RETURN(wanted.role, FromProto(request.role()));
  // 0 would mean that it does not end.
  if (request.has_expires()) {
    wanted.expires_utc_ns = std::max<int64_t>(1, ToUtcNs(request.expires()));
  }
  VS_ASSIGN_OR_RETURN(const Accounts::NewApiKey made, access_.accounts().CreateApiKey(wanted));
  Record(call, Str("made the API key \"", made.record.name, "\""));
  pb::CreateApiKeyResponse response;
  *response.mutable_key() = ToProto(Accounts::ApiKeyInfo{.record = made.record});
  response.set_secret(made.secret);
  return response;
}

Result<pb::ListApiKeysResponse> UserService::ListApiKeys(
    const Call& /*call*/, const pb::ListApiKeysRequest& /*request*/) {
  pb::ListApiKeysResponse response;
  for (const auto& key : access_.accounts().ApiKeys()) *response.add_keys() = ToProto(key);
  return response;
}

Result<pb::RevokeApiKeyResponse> UserService::RevokeApiKey(const Call& call,
                                                           const pb::RevokeApiKeyRequest& request) {
  VS_RETURN_IF_ERROR(access_.accounts().RevokeApiKey(request.id()));
  Record(call, Str("revoked the API key ", request.id()));
  return pb::RevokeApiKeyResponse();
}

}  // namespace vs
