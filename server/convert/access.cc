#include "server/convert/access.h"

#include <string>

#include "engine/base/str.h"
#include "server/convert/time.h"

namespace vs {

namespace pb = visionserver::v1;

pb::Role ToProto(Role role) {
  switch (role) {
    case Role::kViewer:
      return pb::ROLE_VIEWER;
    case Role::kOperator:
      return pb::ROLE_OPERATOR;
    case Role::kEngineer:
      return pb::ROLE_ENGINEER;
    case Role::kAdmin:
      return pb::ROLE_ADMIN;
    case Role::kRobot:
      return pb::ROLE_ROBOT;
  }
  return pb::ROLE_UNSPECIFIED;
}

Result<Role> FromProto(pb::Role role) {
  switch (role) {
    case pb::ROLE_VIEWER:
      return Role::kViewer;
    case pb::ROLE_OPERATOR:
      return Role::kOperator;
    case pb::ROLE_ENGINEER:
      return Role::kEngineer;
    case pb::ROLE_ADMIN:
      return Role::kAdmin;
    case pb::ROLE_ROBOT:
      return Role::kRobot;
    default:
      return InvalidArgument(Str("a role is needed, ", static_cast<int>(role), " is none"));
  }
}

pb::User ToProto(const UserRecord& user, int64_t locked_until_utc_ns) {
  pb::User proto;
  proto.set_name(user.name);
  proto.set_full_name(user.full_name);
  proto.set_role(ToProto(user.role));
  proto.set_disabled(user.disabled);
  proto.set_must_change_password(user.must_change_password);
  *proto.mutable_created() = ToTimestamp(user.created_utc_ns);
  if (user.last_login_utc_ns != 0)
    *proto.mutable_last_login() = ToTimestamp(user.last_login_utc_ns);
  proto.set_etag(std::to_string(user.revision));
  if (locked_until_utc_ns != 0) *proto.mutable_locked_until() = ToTimestamp(locked_until_utc_ns);
  return proto;
}

pb::ApiKey ToProto(const Accounts::ApiKeyInfo& key) {
  pb::ApiKey proto;
  proto.set_id(key.record.id);
  proto.set_name(key.record.name);
  proto.set_role(ToProto(key.record.role));
  *proto.mutable_created() = ToTimestamp(key.record.created_utc_ns);
  proto.set_created_by(key.record.created_by);
  if (key.record.expires_utc_ns != 0) {
    *proto.mutable_expires() = ToTimestamp(key.record.expires_utc_ns);
  }
  if (key.last_used_utc_ns != 0) *proto.mutable_last_used() = ToTimestamp(key.last_used_utc_ns);
  return proto;
}

pb::Session ToProto(const SessionInfo& session, Role role, const std::string& current_id) {
  pb::Session proto;
  proto.set_id(session.record.id);
  proto.set_user(session.record.user);
  proto.set_role(ToProto(role));
  proto.set_address(session.record.address);
  proto.set_client(session.record.client);
  *proto.mutable_created() = ToTimestamp(session.record.created_utc_ns);
  *proto.mutable_last_used() = ToTimestamp(session.last_used_utc_ns);
  *proto.mutable_expires() = ToTimestamp(session.record.expires_utc_ns);
  proto.set_current(session.record.id == current_id);
  return proto;
}

}  // namespace vs
