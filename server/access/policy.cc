#include "server/access/policy.h"

#include <array>

#include "engine/base/str.h"

namespace vs {
namespace {

constexpr RoleSet Only(Role role) { return {1U << static_cast<unsigned>(role)}; }

constexpr RoleSet kRobot = Only(Role::kRobot);
constexpr RoleSet kAdmin = Only(Role::kAdmin);
// People: each role includes the one above it.
constexpr RoleSet kEngineer = Only(Role::kEngineer) | kAdmin;
constexpr RoleSet kOperator = Only(Role::kOperator) | kEngineer;
constexpr RoleSet kViewer = Only(Role::kViewer) | kOperator;
constexpr RoleSet kEverybody = kViewer | kRobot;

constexpr AccessRule Anybody(std::string_view method) {
  return {
      .method = method, .roles = kEverybody, .without_login = true, .before_password_change = true};
}

constexpr AccessRule AtOnce(std::string_view method, RoleSet roles) {
  return {.method = method, .roles = roles, .before_password_change = true};
}

constexpr AccessRule Changes(AccessRule rule) {
  rule.changes = true;
  return rule;
}

constexpr AccessRule Changes(std::string_view method, RoleSet roles) {
  return Changes({.method = method, .roles = roles});
}

// clang-format off
constexpr auto kRules = std::to_array<AccessRule>({
    Changes(Anybody("/visionserver.v1.SessionService/Login")),
    Changes(AtOnce("/visionserver.v1.SessionService/Logout", kViewer)),
    AtOnce("/visionserver.v1.SessionService/WhoAmI", kEverybody),
    Changes(AtOnce("/visionserver.v1.SessionService/ChangePassword", kViewer)),
    {"/visionserver.v1.SessionService/ListMySessions", kViewer},
    Changes("/visionserver.v1.SessionService/RevokeSession", kViewer),

    {"/visionserver.v1.UserService/ListUsers", kAdmin},
    Changes("/visionserver.v1.UserService/CreateUser", kAdmin),
    Changes("/visionserver.v1.UserService/UpdateUser", kAdmin),
    Changes("/visionserver.v1.UserService/DeleteUser", kAdmin),
    Changes("/visionserver.v1.UserService/ResetPassword", kAdmin),
    Changes("/visionserver.v1.UserService/UnlockUser", kAdmin),
    {"/visionserver.v1.UserService/ListSessions", kAdmin},
    Changes("/visionserver.v1.UserService/CreateApiKey", kAdmin),
    {"/visionserver.v1.UserService/ListApiKeys", kAdmin},
    Changes("/visionserver.v1.UserService/RevokeApiKey", kAdmin),

    {"/visionserver.v1.SequenceService/ListSequences", kEverybody},
    {"/visionserver.v1.SequenceService/GetSequence", kEverybody},
    Changes("/visionserver.v1.SequenceService/CreateSequence", kEngineer),
    Changes("/visionserver.v1.SequenceService/UpdateSequence", kEngineer),
    Changes("/visionserver.v1.SequenceService/DeleteSequence", kEngineer),
    {"/visionserver.v1.SequenceService/ValidateSequence", kViewer},
    {"/visionserver.v1.SequenceService/ListBlockTypes", kViewer},
    Changes("/visionserver.v1.SequenceService/StartSequence", kOperator | kRobot),
    Changes("/visionserver.v1.SequenceService/StopSequence", kOperator | kRobot),
    {"/visionserver.v1.SequenceService/GetSequenceState", kEverybody},
    {"/visionserver.v1.SequenceService/WatchSequence", kEverybody},

    {"/visionserver.v1.ParameterService/ListParameters", kEverybody},
    {"/visionserver.v1.ParameterService/GetParameters", kEverybody},
    // Operators and robots only those meant for them: see MaySetEveryParameter.
    Changes("/visionserver.v1.ParameterService/SetParameters", kOperator | kRobot),
    Changes("/visionserver.v1.ParameterService/ResetParameters", kOperator | kRobot),
    {"/visionserver.v1.ParameterService/WatchParameters", kEverybody},

    {"/visionserver.v1.StreamService/ListStreams", kEverybody},
    {"/visionserver.v1.StreamService/Subscribe", kEverybody},
    {"/visionserver.v1.StreamService/Ack", kEverybody},
    {"/visionserver.v1.StreamService/UpdateSubscriptions", kEverybody},
    {"/visionserver.v1.StreamService/GetLatest", kEverybody},

    {"/visionserver.v1.CameraService/ListCameras", kEverybody},
    {"/visionserver.v1.CameraService/DiscoverCameras", kEngineer},
    {"/visionserver.v1.CameraService/GetCamera", kEverybody},
    {"/visionserver.v1.CameraService/ListFeatures", kViewer},
    {"/visionserver.v1.CameraService/GetFeatures", kViewer},
    Changes("/visionserver.v1.CameraService/SetFeatures", kEngineer),
    {"/visionserver.v1.CameraService/TriggerCamera", kOperator | kRobot},
    {"/visionserver.v1.CameraService/WatchCameras", kEverybody},

    {"/visionserver.v1.ResultService/ListResults", kEverybody},
    {"/visionserver.v1.ResultService/GetResult", kEverybody},
    {"/visionserver.v1.ResultService/GetResultFile", kEverybody},
    {"/visionserver.v1.ResultService/QueryResults", kEverybody},
    {"/visionserver.v1.ResultService/ExportResults", kEverybody},
    {"/visionserver.v1.ResultService/WatchResults", kEverybody},

    Anybody("/visionserver.v1.SystemService/GetServerInfo"),
    {"/visionserver.v1.SystemService/GetStatistics", kViewer},
    {"/visionserver.v1.SystemService/GetResources", kViewer},
    {"/visionserver.v1.SystemService/ListAlarms", kEverybody},

    {"/visionserver.v1.AuditService/ListAuditEntries", kAdmin},

    Anybody("/grpc.health.v1.Health/Check"),
    {"/grpc.health.v1.Health/Watch", kEverybody},
    {"/grpc.reflection.v1alpha.ServerReflection/ServerReflectionInfo", kEngineer},
});
// clang-format on

}  // namespace

std::span<const AccessRule> AccessRules() { return kRules; }

const AccessRule* FindAccessRule(std::string_view method) {
  for (const AccessRule& rule : kRules) {
    if (rule.method == method) return &rule;
  }
  return nullptr;
}

Status CheckAccess(std::string_view method, const Caller& caller) {
  const AccessRule* rule = FindAccessRule(method);
  if (rule != nullptr && rule->without_login) return Status();
  if (caller.kind == Caller::Kind::kNobody) {
    return Unauthenticated("log in first: this call needs a valid token");
  }
  if (rule == nullptr) return Unimplemented(Str("there is no method ", method));
  if (caller.must_change_password && !rule->before_password_change) {
    return PermissionDenied("change the one-time password first")
        .WithReason("PASSWORD_CHANGE_REQUIRED");
  }
  if (!rule->roles.Contains(caller.role)) {
    return PermissionDenied(Str("the role ", RoleName(caller.role), " may not call ", method));
  }
  return Status();
}

}  // namespace vs
