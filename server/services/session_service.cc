#include "server/services/session_service.h"

#include <optional>
#include <string>

#include "engine/base/str.h"
#include "server/convert/access.h"
#include "server/convert/time.h"

namespace vs {

namespace pb = visionserver::v1;

void SessionService::Register(Router& router) {
  const MethodOptions hashing = {.lane = Lane::kPassword, .max_request_bytes = 4096};
  MethodOptions login = hashing;
  login.admit = [this](const Call& call) { return access_.AdmitLogin(call.address); };
  const std::string prefix = "/visionserver.v1.SessionService/";
  router.Unary(prefix + "Login", this, &SessionService::Login, login);
  router.Unary(prefix + "Logout", this, &SessionService::Logout);
  router.Unary(prefix + "WhoAmI", this, &SessionService::WhoAmI);
  router.Unary(prefix + "ChangePassword", this, &SessionService::ChangePassword, hashing);
  router.Unary(prefix + "ListMySessions", this, &SessionService::ListMySessions);
  router.Unary(prefix + "RevokeSession", this, &SessionService::RevokeSession);
}

Result<pb::LoginResponse> SessionService::Login(const Call& call, const pb::LoginRequest& request) {
  if (request.user().empty() || request.user().size() > 64) {
    return InvalidArgument("a user name has 1 to 64 bytes");
  }
  if (request.password().empty() || request.password().size() > 1024) {
    return InvalidArgument("a password has 1 to 1024 bytes");
  }
  if (request.client().size() > 128) return InvalidArgument("client has more than 128 bytes");
  VS_ASSIGN_OR_RETURN(
      const AccessControl::LoggedIn login,
      access_.LogIn(request.user(), request.password(), call.address, request.client()));
  pb::LoginResponse response;
  response.set_token(login.token);
  *response.mutable_expires() = ToTimestamp(login.session.expires_utc_ns);
  *response.mutable_idle_timeout() = ToDuration(access_.sessions().limits().idle_ns);
  response.set_must_change_password(login.user.must_change_password);
  response.set_role(ToProto(login.user.role));
  response.set_session_id(login.session.id);
  return response;
}

Result<pb::LogoutResponse> SessionService::Logout(const Call& call,
                                                  const pb::LogoutRequest& /*request*/) {
  if (call.caller.kind != Caller::Kind::kUser) {
    return FailedPrecondition("an API key has no session to end; an administrator can revoke it");
  }
  VS_RETURN_IF_ERROR(access_.sessions().Remove(call.caller.credential_id, call.caller.name));
  return pb::LogoutResponse();
}

Result<pb::WhoAmIResponse> SessionService::WhoAmI(const Call& call,
                                                  const pb::WhoAmIRequest& /*request*/) {
  const Caller& caller = call.caller;
  pb::WhoAmIResponse response;
  response.set_user(caller.name);
  response.set_role(ToProto(caller.role));
  response.set_must_change_password(caller.must_change_password);
  int64_t expires_utc_ns = 0;
  if (caller.kind == Caller::Kind::kUser) {
    response.set_session_id(caller.credential_id);
    if (const auto session = access_.sessions().FindById(caller.credential_id, false)) {
      expires_utc_ns = session->expires_utc_ns;
    }
  } else if (const auto key = access_.accounts().FindApiKeyById(caller.credential_id)) {
    expires_utc_ns = key->expires_utc_ns;
  }
  if (expires_utc_ns != 0) *response.mutable_expires() = ToTimestamp(expires_utc_ns);
  return response;
}

Result<pb::ChangePasswordResponse> SessionService::ChangePassword(
    const Call& call, const pb::ChangePasswordRequest& request) {
  VS_RETURN_IF_ERROR(access_.ChangePassword(call.caller, request.old_password(),
                                            request.new_password(), call.address));
  return pb::ChangePasswordResponse();
}

Result<pb::ListMySessionsResponse> SessionService::ListMySessions(
    const Call& call, const pb::ListMySessionsRequest& /*request*/) {
  pb::ListMySessionsResponse response;
  if (call.caller.kind != Caller::Kind::kUser) return response;
  for (const SessionInfo& session : access_.sessions().List(call.caller.name)) {
    *response.add_sessions() = ToProto(session, call.caller.role, call.caller.credential_id);
  }
  return response;
}

Result<pb::RevokeSessionResponse> SessionService::RevokeSession(
    const Call& call, const pb::RevokeSessionRequest& request) {
  const bool any = call.caller.role == Role::kAdmin;
  if (call.caller.kind != Caller::Kind::kUser) {
    return NotFound(Str("there is no session ", request.session_id()));
  }
  VS_RETURN_IF_ERROR(access_.sessions().Remove(request.session_id(), any ? "" : call.caller.name));
  return pb::RevokeSessionResponse();
}

}  // namespace vs
