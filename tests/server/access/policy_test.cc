#include "server/access/policy.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace vs {
namespace {

// The table as its readers should see it, so that no right changes unnoticed. V viewer, O operator,
// E engineer, A admin, R robot; * without login; + also with a one-time password; ! is recorded.
constexpr const char* kTable =
    "SessionService/Login VOEAR*+!\n"
    "SessionService/Logout VOEA+!\n"
    "SessionService/WhoAmI VOEAR+\n"
    "SessionService/ChangePassword VOEA+!\n"
    "SessionService/ListMySessions VOEA\n"
    "SessionService/RevokeSession VOEA!\n"
    "UserService/ListUsers A\n"
    "UserService/CreateUser A!\n"
    "UserService/UpdateUser A!\n"
    "UserService/DeleteUser A!\n"
    "UserService/ResetPassword A!\n"
    "UserService/UnlockUser A!\n"
    "UserService/ListSessions A\n"
    "UserService/CreateApiKey A!\n"
    "UserService/ListApiKeys A\n"
    "UserService/RevokeApiKey A!\n"
    "SequenceService/ListSequences VOEAR\n"
    "SequenceService/GetSequence VOEAR\n"
    "SequenceService/CreateSequence EA!\n"
    "SequenceService/UpdateSequence EA!\n"
    "SequenceService/DeleteSequence EA!\n"
    "SequenceService/ValidateSequence VOEA\n"
    "SequenceService/ListBlockTypes VOEA\n"
    "SequenceService/StartSequence OEAR!\n"
    "SequenceService/StopSequence OEAR!\n"
    "SequenceService/GetSequenceState VOEAR\n"
    "SequenceService/WatchSequence VOEAR\n"
    "ParameterService/ListParameters VOEAR\n"
    "ParameterService/GetParameters VOEAR\n"
    "ParameterService/SetParameters OEAR!\n"
    "ParameterService/ResetParameters OEAR!\n"
    "ParameterService/WatchParameters VOEAR\n"
    "StreamService/ListStreams VOEAR\n"
    "StreamService/Subscribe VOEAR\n"
    "StreamService/Ack VOEAR\n"
    "StreamService/UpdateSubscriptions VOEAR\n"
    "StreamService/GetLatest VOEAR\n"
    "CameraService/ListCameras VOEAR\n"
    "CameraService/DiscoverCameras EA\n"
    "CameraService/GetCamera VOEAR\n"
    "CameraService/ListFeatures VOEA\n"
    "CameraService/GetFeatures VOEA\n"
    "CameraService/SetFeatures EA!\n"
    "CameraService/TriggerCamera OEAR\n"
    "CameraService/WatchCameras VOEAR\n"
    "ResultService/ListResults VOEAR\n"
    "ResultService/GetResult VOEAR\n"
    "ResultService/GetResultFile VOEAR\n"
    "ResultService/QueryResults VOEAR\n"
    "ResultService/ExportResults VOEAR\n"
    "ResultService/WatchResults VOEAR\n"
    "SystemService/GetServerInfo VOEAR*+\n"
    "SystemService/GetStatistics VOEA\n"
    "SystemService/GetResources VOEA\n"
    "SystemService/ListAlarms VOEAR\n"
    "AuditService/ListAuditEntries A\n"
    "Health/Check VOEAR*+\n"
    "Health/Watch VOEAR\n"
    "ServerReflection/ServerReflectionInfo EA\n";

std::string ToText(const AccessRule& rule) {
  const size_t package_end = rule.method.rfind('.', rule.method.rfind('/'));
  std::string text(rule.method.substr(package_end + 1));
  text += ' ';
  if (rule.roles.Contains(Role::kViewer)) text += 'V';
  if (rule.roles.Contains(Role::kOperator)) text += 'O';
  if (rule.roles.Contains(Role::kEngineer)) text += 'E';
  if (rule.roles.Contains(Role::kAdmin)) text += 'A';
  if (rule.roles.Contains(Role::kRobot)) text += 'R';
  if (rule.without_login) text += '*';
  if (rule.before_password_change) text += '+';
  if (rule.changes) text += '!';
  return text + '\n';
}

constexpr const char* kStart = "/visionserver.v1.SequenceService/StartSequence";

TEST(Policy, IsTheTableThatWasAgreed) {
  std::string text;
  for (const AccessRule& rule : AccessRules()) text += ToText(rule);
  EXPECT_EQ(text, kTable);
}

TEST(Policy, DeniesWhatIsNotInTheTable) {
  const Caller admin = {.kind = Caller::Kind::kUser, .role = Role::kAdmin};
  EXPECT_EQ(CheckAccess("/visionserver.v1.SequenceService/Explode", admin).code(),
            StatusCode::kUnimplemented);
  EXPECT_EQ(CheckAccess("/visionserver.v1.SequenceService/Explode", Caller()).code(),
            StatusCode::kUnauthenticated);
  EXPECT_EQ(CheckAccess("", Caller()).code(), StatusCode::kUnauthenticated);
}

TEST(Policy, DeniesByLoginThenByPasswordThenByRole) {
  EXPECT_EQ(CheckAccess(kStart, Caller()).code(), StatusCode::kUnauthenticated);
  Caller caller = {.kind = Caller::Kind::kUser, .role = Role::kOperator};
  EXPECT_TRUE(CheckAccess(kStart, caller).ok());
  caller.must_change_password = true;
  EXPECT_EQ(CheckAccess(kStart, caller).reason(), "PASSWORD_CHANGE_REQUIRED");
  EXPECT_TRUE(CheckAccess("/visionserver.v1.SessionService/ChangePassword", caller).ok());
  caller = {.kind = Caller::Kind::kUser, .role = Role::kViewer};
  EXPECT_EQ(CheckAccess(kStart, caller).code(), StatusCode::kPermissionDenied);
}

}  // namespace
}  // namespace vs
