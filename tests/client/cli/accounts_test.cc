// Logging in and managing users and keys with the real programs: visionctl and a whole server.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <nlohmann/json.hpp>

#include "tests/client/cli/visionctl.h"
#include "tests/support/test_server.h"
#include "tests/support/wait_until.h"

namespace vs::test {
namespace {

using nlohmann::json;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr char kOwnPassword[] = "a password of my own";

class AccountsTest : public testing::Test {
 protected:
  AccountsTest() : server_({.tls = true}), visionctl_(Options()) {}

  std::vector<std::string> Options() {
    return {"--server", server_->address(), "--fingerprint", server_->fingerprint()};
  }
  void LogInAsAdmin() {
    const FinishedProcess done =
        visionctl_({"login", "admin", "--password-stdin", "--new-password-stdin"},
                   *server_->one_time_password() + "\n" + kOwnPassword + "\n");
    ASSERT_EQ(0, done.exit_code) << done.error_output;
  }
  void LogIn(const Visionctl& visionctl, const std::string& user) {
    const FinishedProcess done =
        visionctl({"login", user, "--password-stdin"}, std::string(TestServer::kPassword) + "\n");
    ASSERT_EQ(0, done.exit_code) << done.error_output;
  }

  TestServer server_;
  Visionctl visionctl_;
};

TEST_F(AccountsTest, TheFirstLoginChoosesAPasswordAndIsKept) {
  LogInAsAdmin();
  const std::filesystem::path stored = visionctl_.home() / "visionserver/credentials.json";
  struct stat facts {};
  ASSERT_EQ(0, ::stat(stored.c_str(), &facts));
  EXPECT_EQ(0600U, facts.st_mode & 0777);

  // Server, fingerprint and token come from the login now.
  Visionctl bare;
  bare.environment()["XDG_CONFIG_HOME"] = visionctl_.home().path();
  const FinishedProcess me = bare({"whoami"});
  EXPECT_EQ(0, me.exit_code) << me.error_output;
  EXPECT_THAT(me.output, HasSubstr("admin (admin), until 2"));

  EXPECT_EQ(0, bare({"logout"}).exit_code);
  const FinishedProcess nobody = bare({"whoami"});
  EXPECT_EQ(4, nobody.exit_code);
  EXPECT_THAT(nobody.error_output, HasSubstr("log in first"));

  const FinishedProcess again =
      bare({"login", "admin", "--password-stdin"}, std::string(kOwnPassword) + "\n");
  EXPECT_EQ(0, again.exit_code) << again.error_output;
}

TEST_F(AccountsTest, AOneTimePasswordAloneIsNotEnough) {
  const FinishedProcess done = visionctl_({"login", "--password-stdin", "--new-password-stdin"},
                                          *server_->one_time_password() + "\n");
  EXPECT_EQ(6, done.exit_code);
  EXPECT_THAT(done.error_output, HasSubstr("standard input holds no (further) password"));
  EXPECT_EQ(4, visionctl_({"users", "list"}).exit_code);
}

TEST_F(AccountsTest, WrongPasswordsAndTokensEndWithFour) {
  EXPECT_EQ(4, visionctl_({"login", "admin", "--password-stdin"}, "wrong password\n").exit_code);
  EXPECT_EQ(4, visionctl_({"login", "nobody", "--password-stdin"}, "wrong password\n").exit_code);
  EXPECT_EQ(4, visionctl_({"users", "list"}).exit_code);
  visionctl_.environment()["VISIONSERVER_TOKEN"] = "forged";
  EXPECT_EQ(4, visionctl_({"sequences", "list"}).exit_code);
}

TEST_F(AccountsTest, TheTokenIsNeverPrinted) {
  server_.AddUser("ana", Role::kViewer);
  const FinishedProcess done = visionctl_({"login", "ana", "--password-stdin", "--json"},
                                          std::string(TestServer::kPassword) + "\n");
  ASSERT_EQ(0, done.exit_code) << done.error_output;
  EXPECT_EQ("ROLE_VIEWER", json::parse(done.output).at("role"));
  EXPECT_EQ("", json::parse(done.output).at("token"));
}

TEST_F(AccountsTest, AdministratorsManageUsers) {
  LogInAsAdmin();
  const FinishedProcess made = visionctl_(
      {"users", "create", "ana", "--role", "engineer", "--full-name", "Ana Kim", "--json"});
  ASSERT_EQ(0, made.exit_code) << made.error_output;
  const std::string one_time = json::parse(made.output).at("one_time_password");

  EXPECT_EQ(8, visionctl_({"users", "create", "ANA"}).exit_code);
  EXPECT_EQ(6, visionctl_({"users", "create", "bob", "--role", "boss"}).exit_code);
  EXPECT_EQ(6, visionctl_({"users", "create", "no blanks"}).exit_code);
  EXPECT_EQ(5, visionctl_({"users", "update", "nobody", "--disable"}).exit_code);
  EXPECT_EQ(8, visionctl_({"users", "delete", "admin"}).exit_code);

  EXPECT_THAT(visionctl_({"users", "update", "ana", "--role", "operator"}).output,
              HasSubstr("ana: operator"));
  EXPECT_THAT(visionctl_({"users", "list"}).output,
              ContainsRegex("ana +operator +Ana Kim +one-time password"));

  Visionctl ana(Options());
  const FinishedProcess in = ana({"login", "ana", "--password-stdin", "--new-password-stdin"},
                                 one_time + "\n" + kOwnPassword + "\n");
  EXPECT_EQ(0, in.exit_code) << in.error_output;
  EXPECT_EQ(4, ana({"users", "list"}).exit_code);
  EXPECT_THAT(visionctl_({"users", "sessions", "--user", "ana"}).output,
              HasSubstr("visionctl on "));

  EXPECT_EQ(0, visionctl_({"users", "update", "ana", "--disable"}).exit_code);
  EXPECT_EQ(4, ana({"whoami"}).exit_code);
  EXPECT_EQ(0, visionctl_({"users", "delete", "ana"}).exit_code);
  EXPECT_THAT(visionctl_({"users", "list"}).output, Not(HasSubstr("ana")));
}

TEST_F(AccountsTest, SessionsEndOnRequest) {
  LogInAsAdmin();
  server_.AddUser("ana", Role::kViewer);
  const Visionctl ana(Options());
  LogIn(ana, "ana");
  const json sessions =
      json::parse(visionctl_({"users", "sessions", "--user", "ana", "--json"}).output);
  const std::string id = sessions.at("sessions")[0].at("id");
  EXPECT_EQ(0, visionctl_({"users", "revoke-session", id}).exit_code);
  EXPECT_EQ(4, ana({"whoami"}).exit_code);
  EXPECT_EQ(5, visionctl_({"users", "revoke-session", id}).exit_code);
}

TEST_F(AccountsTest, PasswordsAreChangedAndReset) {
  server_.AddUser("ana", Role::kViewer);
  const Visionctl ana(Options());
  LogIn(ana, "ana");
  EXPECT_EQ(6, ana({"passwd", "--password-stdin"}, std::string(TestServer::kPassword) + "\nshort\n")
                   .exit_code);
  EXPECT_EQ(0, ana({"passwd", "--password-stdin"},
                   std::string(TestServer::kPassword) + "\n" + kOwnPassword + "\n")
                   .exit_code);
  EXPECT_EQ(0,
            ana({"login", "ana", "--password-stdin"}, std::string(kOwnPassword) + "\n").exit_code);

  LogInAsAdmin();
  EXPECT_THAT(visionctl_({"users", "reset-password", "ana"}).output,
              HasSubstr("one-time password of ana"));
  EXPECT_EQ(4, ana({"whoami"}).exit_code);
}

TEST_F(AccountsTest, LockedUsersAreUnlocked) {
  server_.AddUser("ana", Role::kViewer);
  const Visionctl ana(Options());
  for (int i = 0; i < 5; ++i) ana({"login", "ana", "--password-stdin"}, "wrong password\n");
  LogInAsAdmin();
  EXPECT_THAT(visionctl_({"users", "unlock", "ana"}).output, HasSubstr("ana may log in again"));
  LogIn(ana, "ana");
  EXPECT_EQ(5, visionctl_({"users", "unlock", "nobody"}).exit_code);
}

TEST_F(AccountsTest, AdministratorsSeeWhoChangedWhat) {
  LogInAsAdmin();
  EXPECT_EQ(0, visionctl_({"users", "create", "ana"}).exit_code);
  FinishedProcess shown;
  // An entry is written a moment after its call.
  EXPECT_TRUE(WaitUntil([&] {
    shown = visionctl_({"audit", "--user", "admin", "--method", "CreateUser", "--limit", "5"});
    return shown.output.find("ana") != std::string::npos;
  }));
  EXPECT_THAT(shown.output, ContainsRegex("admin +127.0.0.1 +UserService/CreateUser +ana +ok"));
  server_.AddUser("ben", Role::kEngineer);
  const Visionctl ben(Options());
  LogIn(ben, "ben");
  EXPECT_EQ(4, ben({"audit"}).exit_code);
}

TEST_F(AccountsTest, KeysLetMachinesInUntilTheyAreRevoked) {
  LogInAsAdmin();
  const FinishedProcess made = visionctl_({"keys", "create", "robot cell 7", "--json"});
  ASSERT_EQ(0, made.exit_code) << made.error_output;
  const json key = json::parse(made.output);

  Visionctl robot(Options());
  robot.environment()["VISIONSERVER_TOKEN"] = key.at("secret");
  EXPECT_THAT(robot({"whoami"}).output, HasSubstr("robot cell 7 (robot)"));
  EXPECT_EQ(4, robot({"users", "list"}).exit_code);
  EXPECT_THAT(visionctl_({"keys", "list"}).output, ContainsRegex("robot cell 7 +robot +admin"));

  EXPECT_EQ(0, visionctl_({"keys", "revoke", key.at("key").at("id")}).exit_code);
  EXPECT_EQ(4, robot({"whoami"}).exit_code);
  EXPECT_EQ(5, visionctl_({"keys", "revoke", "nonsense"}).exit_code);
}

TEST_F(AccountsTest, StatusShowsTheServer) {
  LogInAsAdmin();
  const FinishedProcess shown = visionctl_({"status"});
  EXPECT_EQ(0, shown.exit_code) << shown.error_output;
  EXPECT_THAT(shown.output, HasSubstr("VisionServer "));
  EXPECT_THAT(shown.output, HasSubstr("sessions 1"));
  const json root = json::parse(visionctl_({"status", "--json"}).output);
  EXPECT_EQ("VisionServer", root.at("info").at("product"));
  EXPECT_TRUE(root.at("alarms").at("alarms").is_array());
}

}  // namespace
}  // namespace vs::test
