#pragma once

#include "visionserver/v1/session.pb.h"

#include "engine/base/status.h"
#include "server/access/access_control.h"
#include "server/rpc/router.h"

namespace vs {

// Logging in and out: see session.proto.
class SessionService {
 public:
  explicit SessionService(AccessControl& access) : access_(access) {}
  void Register(Router& router);

 private:
  Result<visionserver::v1::LoginResponse> Login(const Call& call,
                                                const visionserver::v1::LoginRequest& request);
  Result<visionserver::v1::LogoutResponse> Logout(const Call& call,
                                                  const visionserver::v1::LogoutRequest& request);
  Result<visionserver::v1::WhoAmIResponse> WhoAmI(const Call& call,
                                                  const visionserver::v1::WhoAmIRequest& request);
  Result<visionserver::v1::ChangePasswordResponse> ChangePassword(
      const Call& call, const visionserver::v1::ChangePasswordRequest& request);
  Result<visionserver::v1::ListMySessionsResponse> ListMySessions(
      const Call& call, const visionserver::v1::ListMySessionsRequest& request);
  Result<visionserver::v1::RevokeSessionResponse> RevokeSession(
      const Call& call, const visionserver::v1::RevokeSessionRequest& request);

  AccessControl& access_;
};

}  // namespace vs
