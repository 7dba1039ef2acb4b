#pragma once

#include "visionserver/v1/session.pb.h"
#include "visionserver/v1/user.pb.h"

#include "engine/base/status.h"
#include "server/access/accounts.h"
#include "server/access/sessions.h"

namespace vs {

visionserver::v1::Role ToProto(Role role);
// INVALID_ARGUMENT for ROLE_UNSPECIFIED and numbers that are no role.
Result<Role> FromProto(visionserver::v1::Role role);

// `locked_until_utc_ns`: as AccessControl::LockedUntilUtcNs.
visionserver::v1::User ToProto(const UserRecord& user, int64_t locked_until_utc_ns);
visionserver::v1::ApiKey ToProto(const Accounts::ApiKeyInfo& key);
// `role`: of the session's user now; `current_id`: of the session that asks.
visionserver::v1::Session ToProto(const SessionInfo& session, Role role,
                                  const std::string& current_id);

}  // namespace vs
