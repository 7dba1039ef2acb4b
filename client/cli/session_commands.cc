#include "visionserver/v1/session.grpc.pb.h"

#include "client/cli/command.h"
#include "client/cli/password.h"
#include "client/cli/words.h"

namespace vs::cli {
namespace {

struct LoginArguments {
  Argument<std::string> user;
  Argument<bool> password_stdin;
  Argument<bool> new_password_stdin;
};

Result<std::string> NewPassword(bool from_stdin) {
  if (from_stdin) return ReadPasswordLine();
  VS_CLI_TRY(const std::string first,
             AskPassword("New password (10 characters or more)", "--new-password-stdin"));
  VS_CLI_TRY(const std::string second, AskPassword("Once more", "--new-password-stdin"));
  if (first != second) {
    return client::Failure(client::Code::kInvalidArgument, "the two passwords differ");
  }
  return first;
}

Result<void> Login(Session& session, const LoginArguments& arguments) {
  VS_CLI_TRY(client::Client * client, session.ConnectWithoutLogin());
  const std::string user = arguments.user->empty() ? "admin" : *arguments.user;
  VS_CLI_TRY(const std::string password,
             *arguments.password_stdin ? ReadPasswordLine()
                                       : AskPassword("Password of " + user, "--password-stdin"));
  VS_CLI_TRY(v1::LoginResponse login, client->Login(user, password));
  if (login.must_change_password()) {
    if (!session.options().json) {
      std::fputs("The password was for one time only; choose one of your own.\n", stderr);
    }
    VS_CLI_TRY(const std::string chosen, NewPassword(*arguments.new_password_stdin));
    if (auto done = client->ChangePassword(password, chosen); !done) return done;
    login.set_must_change_password(false);
  }
  if (auto done = session.Remember(user, login.token()); !done) return done;
  login.clear_token();  // it is stored; a log of this output is no place for it
  return Show(session, Result<v1::LoginResponse>(login), [&](const v1::LoginResponse& response) {
    PrintLine("Logged in as " + user + " (" + RoleWord(response.role()) + ") until " +
              TimeText(response.expires()) + ".");
  });
}

Result<void> ChangePassword(Session& session, bool from_stdin) {
  VS_CLI_TRY(client::Client * client, session.Connect());
  VS_CLI_TRY(const std::string old,
             from_stdin ? ReadPasswordLine() : AskPassword("Present password", "--password-stdin"));
  VS_CLI_TRY(const std::string chosen, NewPassword(from_stdin));
  if (auto done = client->ChangePassword(old, chosen); !done) return done;
  if (!session.options().json) PrintLine("Password changed; your other sessions have ended.");
  return {};
}

Result<void> WhoAmI(Session& session) {
  VS_CLI_TRY(client::Client * client, session.Connect());
  return Show(session, client->WhoAmI(), [](const v1::WhoAmIResponse& me) {
    PrintLine(me.user() + " (" + RoleWord(me.role()) + "), until " + TimeText(me.expires()) +
              (me.must_change_password() ? ", must change the password first" : ""));
  });
}

Result<void> Logout(Session& session) {
  VS_CLI_TRY(client::Client * client, session.Connect());
  Result<void> done = client->Logout();
  if (!done && done.error().code != client::Code::kUnauthenticated) return done;
  if (auto forgotten = session.Forget(); !forgotten) return forgotten;
  if (!session.options().json) PrintLine("Logged out.");
  return {};
}

}  // namespace

void AddSessionCommands(CommandLine& line) {
  Command& login = line.Add("login", "Log in, and keep the login for later commands");
  login.Example("visionctl login admin --server cell-7 --fingerprint AB:CD:...")
      .Example("echo \"$PASSWORD\" | visionctl login operator --password-stdin")
      .Example(
          "printf '%s\\n' \"$ONE_TIME\" \"$OWN\" | "
          "visionctl login admin --password-stdin --new-password-stdin");
  const LoginArguments arguments = {
      .user = login.OptionalPositional("USER", "Who logs in; otherwise admin"),
      .password_stdin = login.Flag("--password-stdin", "Read the password from standard input"),
      .new_password_stdin = login.Flag(
          "--new-password-stdin", "After a one-time password, read one's own from the next line")};
  login.Run([arguments](Session& session) { return Login(session, arguments); });

  Command& logout = line.Add("logout", "End the session and forget its token");
  logout.Run(Logout);

  Command& whoami = line.Add("whoami", "Show who is logged in");
  whoami.Run(WhoAmI);

  Command& passwd = line.Add("passwd", "Change one's own password");
  const auto from_stdin =
      passwd.Flag("--password-stdin", "Read the present and the new password, one a line");
  passwd.Run([from_stdin](Session& session) { return ChangePassword(session, *from_stdin); });
}

}  // namespace vs::cli
