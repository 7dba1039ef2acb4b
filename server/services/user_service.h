#pragma once

#include "visionserver/v1/user.pb.h"

#include "engine/base/status.h"
#include "server/access/access_control.h"
#include "server/rpc/router.h"

namespace vs {

// Users and API keys, for administrators: see user.proto.
class UserService {
 public:
  explicit UserService(AccessControl& access) : access_(access) {}
  void Register(Router& router);

 private:
  Result<visionserver::v1::ListUsersResponse> ListUsers(
      const Call& call, const visionserver::v1::ListUsersRequest& request);
  Result<visionserver::v1::CreateUserResponse> CreateUser(
      const Call& call, const visionserver::v1::CreateUserRequest& request);
  Result<visionserver::v1::User> UpdateUser(const Call& call,
                                            const visionserver::v1::UpdateUserRequest& request);
  Result<visionserver::v1::DeleteUserResponse> DeleteUser(
      const Call& call, const visionserver::v1::DeleteUserRequest& request);
  Result<visionserver::v1::ResetPasswordResponse> ResetPassword(
      const Call& call, const visionserver::v1::ResetPasswordRequest& request);
  Result<visionserver::v1::User> UnlockUser(const Call& call,
                                            const visionserver::v1::UnlockUserRequest& request);
  Result<visionserver::v1::ListSessionsResponse> ListSessions(
      const Call& call, const visionserver::v1::ListSessionsRequest& request);
  Result<visionserver::v1::CreateApiKeyResponse> CreateApiKey(
      const Call& call, const visionserver::v1::CreateApiKeyRequest& request);
  Result<visionserver::v1::ListApiKeysResponse> ListApiKeys(
      const Call& call, const visionserver::v1::ListApiKeysRequest& request);
  Result<visionserver::v1::RevokeApiKeyResponse> RevokeApiKey(
      const Call& call, const visionserver::v1::RevokeApiKeyRequest& request);

  visionserver::v1::User Shown(const UserRecord& user) const;

  AccessControl& access_;
};

}  // namespace vs
