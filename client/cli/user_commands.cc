#include "visionserver/v1/session.grpc.pb.h"
#include "visionserver/v1/user.grpc.pb.h"

#include "client/cli/command.h"
#include "client/cli/words.h"

namespace vs::cli {
namespace {

using Stub = v1::UserService::Stub;

template <class Request>
Request ForUser(const std::string& name) {
  Request request;
  request.set_name(name);
  return request;
}

void PrintUser(const v1::User& user) {
  PrintLine(user.name() + ": " + RoleWord(user.role()) + (user.disabled() ? ", disabled" : ""));
}

std::string StateWord(const v1::User& user) {
  if (user.disabled()) return "disabled";
  if (user.has_locked_until()) return "locked until " + TimeText(user.locked_until());
  return user.must_change_password() ? "one-time password" : "active";
}

Result<void> List(Session& session) {
  return Show(session, Ask(session, &Stub::ListUsers, {}),
              [](const v1::ListUsersResponse& response) {
                Table table({"USER", "ROLE", "FULL NAME", "STATE", "LAST LOGIN"});
                for (const v1::User& user : response.users()) {
                  table.Add({user.name(), RoleWord(user.role()), user.full_name(), StateWord(user),
                             TimeText(user.last_login())});
                }
                table.Print("There are no users.");
              });
}

Result<void> Create(Session& session, const std::string& name, const std::string& role,
                    const std::string& full_name) {
  v1::CreateUserRequest request;
  request.set_name(name);
  request.set_full_name(full_name);
  VS_CLI_TRY(const v1::Role parsed, ParseRole(role));
  request.set_role(parsed);
  return Show(session, Ask(session, &Stub::CreateUser, request),
              [](const v1::CreateUserResponse& response) {
                PrintUser(response.user());
                PrintLine("one-time password, valid for 24 hours: " + response.one_time_password());
              });
}

struct Changes {
  Argument<std::string> role;
  Argument<std::string> full_name;
  Argument<bool> disable;
  Argument<bool> enable;
};

Result<void> Update(Session& session, const std::string& name, const Changes& changes) {
  auto request = ForUser<v1::UpdateUserRequest>(name);
  if (!changes.role->empty()) {
    VS_CLI_TRY(const v1::Role role, ParseRole(*changes.role));
    request.set_role(role);
  }
  if (!changes.full_name->empty()) request.set_full_name(*changes.full_name);
  if (*changes.disable || *changes.enable) request.set_disabled(*changes.disable);
  return Show(session, Ask(session, &Stub::UpdateUser, request), PrintUser);
}

Result<void> Delete(Session& session, const std::string& name) {
  return Show(session, Ask(session, &Stub::DeleteUser, ForUser<v1::DeleteUserRequest>(name)),
              [&](const v1::DeleteUserResponse&) { PrintLine(name + " is deleted."); });
}

Result<void> ResetPassword(Session& session, const std::string& name) {
  return Show(session, Ask(session, &Stub::ResetPassword, ForUser<v1::ResetPasswordRequest>(name)),
              [&](const v1::ResetPasswordResponse& response) {
                PrintLine("one-time password of " + name +
                          ", valid for 24 hours: " + response.one_time_password());
              });
}

Result<void> Unlock(Session& session, const std::string& name) {
  return Show(session, Ask(session, &Stub::UnlockUser, ForUser<v1::UnlockUserRequest>(name)),
              [](const v1::User& user) { PrintLine(user.name() + " may log in again."); });
}

Result<void> Sessions(Session& session, const std::string& user) {
  v1::ListSessionsRequest request;
  request.set_user(user);
  return Show(session, Ask(session, &Stub::ListSessions, request),
              [](const v1::ListSessionsResponse& response) {
                Table table({"SESSION", "USER", "ROLE", "FROM", "CLIENT", "LAST USED", "UNTIL"});
                for (const v1::Session& one : response.sessions()) {
                  table.Add({one.id() + (one.current() ? " (this one)" : ""), one.user(),
                             RoleWord(one.role()), one.address(), one.client(),
                             TimeText(one.last_used()), TimeText(one.expires())});
                }
                table.Print("Nobody is logged in.");
              });
}

Result<void> Revoke(Session& session, const std::string& id) {
  v1::RevokeSessionRequest request;
  request.set_session_id(id);
  return Show(session, Ask(session, &v1::SessionService::Stub::RevokeSession, request),
              [](const v1::RevokeSessionResponse&) { PrintLine("The session has ended."); });
}

}  // namespace

void AddUserCommands(CommandLine& line) {
  line.AddGroup("users", "People: who may log in, and as what (administrators only)");
  const std::string whom = "Login name";
  const std::string roles = "viewer, operator, engineer or admin";

  line.Add("users list", "Show all users").Run(List);

  Command& create = line.Add("users create", "Add a user with a one-time password");
  const auto created = create.Positional("NAME", whom);
  const auto role = create.Text("--role", "ROLE", roles, "viewer");
  const auto full_name = create.Text("--full-name", "TEXT", "For people");
  create.Example("visionctl users create ana --role engineer --full-name \"Ana Kim\"");
  create.Run([=](Session& session) { return Create(session, *created, *role, *full_name); });

  Command& update = line.Add("users update", "Change a user's role or name, disable or enable");
  const auto updated = update.Positional("NAME", whom);
  const Changes changes = {.role = update.Text("--role", "ROLE", roles),
                           .full_name = update.Text("--full-name", "TEXT", "For people"),
                           .disable = update.Flag("--disable", "The user may not log in any more"),
                           .enable = update.Flag("--enable", "The user may log in again")};
  update.Example("visionctl users update ana --role operator");
  update.Run([=](Session& session) { return Update(session, *updated, changes); });

  Command& remove = line.Add("users delete", "Remove a user and end the sessions");
  const auto deleted = remove.Positional("NAME", whom);
  remove.Run([=](Session& session) { return Delete(session, *deleted); });

  Command& reset = line.Add("users reset-password", "Give a user a new one-time password");
  const auto reset_user = reset.Positional("NAME", whom);
  reset.Run([=](Session& session) { return ResetPassword(session, *reset_user); });

  Command& unlock =
      line.Add("users unlock", "Let a user log in again whom failed logins have locked out");
  const auto unlocked = unlock.Positional("NAME", whom);
  unlock.Run([=](Session& session) { return Unlock(session, *unlocked); });

  Command& sessions = line.Add("users sessions", "Show who is logged in");
  const auto of = sessions.Text("--user", "NAME", "Only this user's");
  sessions.Run([=](Session& session) { return Sessions(session, *of); });

  Command& revoke = line.Add("users revoke-session", "End somebody's session");
  const auto id = revoke.Positional("SESSION", "Its id, see users sessions");
  revoke.Run([=](Session& session) { return Revoke(session, *id); });
}

}  // namespace vs::cli
