#include <gmock/gmock.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include "grpc/health/v1/health.pb.h"
#include "visionserver/v1/session.grpc.pb.h"
#include "visionserver/v1/user.grpc.pb.h"

#include "tests/support/client_call.h"
#include "tests/support/fake_clock.h"
#include "tests/support/raw_call.h"
#include "tests/support/test_server.h"

namespace vs {
namespace {

namespace pb = visionserver::v1;
using test::ClientCall;
using test::ReasonOf;
using test::TestServer;

// The services of sessions and users, over the network.
class SessionServiceTest : public ::testing::Test {
 protected:
  grpc::Status Login(const std::string& user, const std::string& password,
                     pb::LoginResponse* response) {
    pb::LoginRequest request;
    request.set_user(user);
    request.set_password(password);
    request.set_client("a test");
    return sessions_->Login(ClientCall("").context(), request, response);
  }
  std::string TokenOf(const std::string& user, const std::string& password) {
    pb::LoginResponse response;
    const grpc::Status status = Login(user, password, &response);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return response.token();
  }
  grpc::Status WhoAmI(const std::string& token, pb::WhoAmIResponse* response) {
    return sessions_->WhoAmI(ClientCall(token).context(), {}, response);
  }
  grpc::Status WhoAmI(const std::string& token) {
    pb::WhoAmIResponse response;
    return WhoAmI(token, &response);
  }

  test::FakeClock clock_;
  TestServer server_{{.clock = &clock_}};
  std::shared_ptr<grpc::Channel> channel_ = server_.Connect();
  std::unique_ptr<pb::SessionService::Stub> sessions_ = pb::SessionService::NewStub(channel_);
  std::unique_ptr<pb::UserService::Stub> users_ = pb::UserService::NewStub(channel_);
};

TEST_F(SessionServiceTest, NewServerIsTakenOverWithItsOneTimePassword) {
  ASSERT_TRUE(server_->one_time_password().has_value());
  const std::string one_time = *server_->one_time_password();
  pb::LoginResponse login;
  ASSERT_TRUE(Login("admin", one_time, &login).ok());
  EXPECT_TRUE(login.must_change_password());
  EXPECT_EQ(login.role(), pb::ROLE_ADMIN);
  EXPECT_EQ(login.idle_timeout().seconds(), 1800);

  pb::ListUsersResponse users;
  const grpc::Status refused = users_->ListUsers(ClientCall(login.token()).context(), {}, &users);
  EXPECT_EQ(refused.error_code(), grpc::StatusCode::PERMISSION_DENIED);
  EXPECT_EQ(ReasonOf(refused), "PASSWORD_CHANGE_REQUIRED");

  pb::ChangePasswordRequest change;
  change.set_old_password(one_time);
  change.set_new_password("correct horse battery");
  pb::ChangePasswordResponse changed;
  ASSERT_TRUE(
      sessions_->ChangePassword(ClientCall(login.token()).context(), change, &changed).ok());
  ASSERT_TRUE(users_->ListUsers(ClientCall(login.token()).context(), {}, &users).ok());
  ASSERT_EQ(users.users_size(), 1);
  EXPECT_EQ(users.users(0).name(), "admin");
  EXPECT_FALSE(users.users(0).must_change_password());

  server_.Restart();
  EXPECT_FALSE(server_->one_time_password().has_value());
}

TEST_F(SessionServiceTest, SaysTheSameToAnUnknownUserAndAWrongPassword) {
  server_.AddUser("maria", Role::kViewer);
  pb::LoginResponse response;
  const grpc::Status wrong = Login("maria", "a wrong one!", &response);
  const grpc::Status unknown = Login("nobody", "a wrong one!", &response);
  EXPECT_EQ(wrong.error_code(), grpc::StatusCode::UNAUTHENTICATED);
  EXPECT_EQ(wrong.error_message(), unknown.error_message());
  EXPECT_EQ(wrong.error_details(), unknown.error_details());
}

TEST_F(SessionServiceTest, RefusesRequestsThatAreNoLogin) {
  pb::LoginResponse response;
  EXPECT_EQ(Login("", "something", &response).error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(Login("maria", "", &response).error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(Login(std::string(65, 'm'), "something", &response).error_code(),
            grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(Login("maria", std::string(1025, 'p'), &response).error_code(),
            grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(Login("maria", std::string(5000, 'p'), &response).error_code(),
            grpc::StatusCode::RESOURCE_EXHAUSTED);
  // None of them cost a hash.
  EXPECT_EQ(server_->access().failed_logins(), 0U);
}

TEST_F(SessionServiceTest, SlowsGuessingDown) {
  server_.AddUser("maria", Role::kViewer);
  pb::LoginResponse response;
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(Login("maria", "a wrong one!", &response).error_code(),
              grpc::StatusCode::UNAUTHENTICATED);
  }
  const grpc::Status slowed = Login("maria", TestServer::kPassword, &response);
  EXPECT_EQ(slowed.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_EQ(ReasonOf(slowed), "TOO_MANY_FAILED_LOGINS");
  clock_.Advance(std::chrono::seconds(1));
  EXPECT_TRUE(Login("maria", TestServer::kPassword, &response).ok());
}

TEST_F(SessionServiceTest, KnowsWhoCalls) {
  server_.AddUser("maria", Role::kOperator);
  pb::WhoAmIResponse me;
  ASSERT_TRUE(WhoAmI(TokenOf("Maria", TestServer::kPassword), &me).ok());
  EXPECT_EQ(me.user(), "maria");
  EXPECT_EQ(me.role(), pb::ROLE_OPERATOR);
  EXPECT_FALSE(me.session_id().empty());
  EXPECT_EQ(me.expires().seconds(), 1'700'000'000 + 12 * 3600);

  ASSERT_TRUE(WhoAmI(server_.Token(Role::kRobot), &me).ok());
  EXPECT_EQ(me.role(), pb::ROLE_ROBOT);
  EXPECT_FALSE(me.has_expires());
}

TEST_F(SessionServiceTest, LogoutMakesTheTokenWorthless) {
  server_.AddUser("maria", Role::kViewer);
  const std::string token = TokenOf("maria", TestServer::kPassword);
  const std::string other = TokenOf("maria", TestServer::kPassword);
  pb::LogoutResponse response;
  ASSERT_TRUE(sessions_->Logout(ClientCall(token).context(), {}, &response).ok());
  EXPECT_EQ(WhoAmI(token).error_code(), grpc::StatusCode::UNAUTHENTICATED);
  EXPECT_TRUE(WhoAmI(other).ok());
}

TEST_F(SessionServiceTest, TokenExpires) {
  server_.AddUser("maria", Role::kViewer);
  const std::string token = TokenOf("maria", TestServer::kPassword);
  clock_.Advance(std::chrono::minutes(29));
  EXPECT_TRUE(WhoAmI(token).ok());
  clock_.Advance(std::chrono::minutes(30));
  EXPECT_EQ(WhoAmI(token).error_code(), grpc::StatusCode::UNAUTHENTICATED);
}

TEST_F(SessionServiceTest, TokenSurvivesARestart) {
  server_.AddUser("maria", Role::kViewer);
  const std::string token = TokenOf("maria", TestServer::kPassword);
  server_.Restart();
  channel_ = server_.Connect();
  sessions_ = pb::SessionService::NewStub(channel_);
  EXPECT_TRUE(WhoAmI(token).ok());
}

TEST_F(SessionServiceTest, OwnSessionsCanBeSeenAndEnded) {
  server_.AddUser("maria", Role::kViewer);
  server_.AddUser("ben", Role::kViewer);
  const std::string first = TokenOf("maria", TestServer::kPassword);
  clock_.Advance(std::chrono::seconds(1));
  const std::string second = TokenOf("maria", TestServer::kPassword);
  const std::string bens = TokenOf("ben", TestServer::kPassword);

  pb::ListMySessionsResponse list;
  ASSERT_TRUE(sessions_->ListMySessions(ClientCall(second).context(), {}, &list).ok());
  ASSERT_EQ(list.sessions_size(), 2);
  EXPECT_TRUE(list.sessions(0).current());
  EXPECT_FALSE(list.sessions(1).current());
  EXPECT_EQ(list.sessions(1).address(), "127.0.0.1");
  EXPECT_EQ(list.sessions(1).client(), "a test");

  pb::RevokeSessionRequest revoke;
  revoke.set_session_id(list.sessions(1).id());
  pb::RevokeSessionResponse revoked;
  EXPECT_EQ(sessions_->RevokeSession(ClientCall(bens).context(), revoke, &revoked).error_code(),
            grpc::StatusCode::NOT_FOUND);
  EXPECT_TRUE(sessions_->RevokeSession(ClientCall(second).context(), revoke, &revoked).ok());
  EXPECT_EQ(WhoAmI(first).error_code(), grpc::StatusCode::UNAUTHENTICATED);
}

TEST_F(SessionServiceTest, RevokedSessionEndsItsOpenStream) {
  server_.AddUser("maria", Role::kViewer);
  const std::string token = TokenOf("maria", TestServer::kPassword);
  test::RawCall stream(channel_, "/grpc.health.v1.Health/Watch", token);
  ASSERT_TRUE(stream.Send(""));
  stream.CloseRequests();
  ASSERT_TRUE(stream.Receive().has_value());

  const std::string admin = server_.Token(Role::kAdmin);
  pb::ListSessionsResponse list;
  pb::ListSessionsRequest of_maria;
  of_maria.set_user("maria");
  ASSERT_TRUE(users_->ListSessions(ClientCall(admin).context(), of_maria, &list).ok());
  ASSERT_EQ(list.sessions_size(), 1);
  pb::RevokeSessionRequest revoke;
  revoke.set_session_id(list.sessions(0).id());
  pb::RevokeSessionResponse revoked;
  ASSERT_TRUE(sessions_->RevokeSession(ClientCall(admin).context(), revoke, &revoked).ok());
  EXPECT_FALSE(stream.Receive().has_value());
  EXPECT_EQ(stream.Finish().error_code(), grpc::StatusCode::UNAUTHENTICATED);
}

TEST_F(SessionServiceTest, DisabledUserLosesTheOpenStream) {
  server_.AddUser("maria", Role::kViewer);
  test::RawCall stream(channel_, "/grpc.health.v1.Health/Watch",
                       TokenOf("maria", TestServer::kPassword));
  ASSERT_TRUE(stream.Send(""));
  ASSERT_TRUE(stream.Receive().has_value());
  pb::UpdateUserRequest disable;
  disable.set_name("maria");
  disable.set_disabled(true);
  pb::User user;
  ASSERT_TRUE(
      users_->UpdateUser(ClientCall(server_.Token(Role::kAdmin)).context(), disable, &user).ok());
  EXPECT_FALSE(stream.Receive().has_value());
  EXPECT_EQ(stream.Finish().error_code(), grpc::StatusCode::UNAUTHENTICATED);
}

TEST_F(SessionServiceTest, AdministratorManagesUsers) {
  const std::string admin = server_.Token(Role::kAdmin);
  pb::CreateUserRequest create;
  create.set_name("Maria");
  create.set_full_name("María González");
  create.set_role(pb::ROLE_OPERATOR);
  pb::CreateUserResponse created;
  ASSERT_TRUE(users_->CreateUser(ClientCall(admin).context(), create, &created).ok());
  EXPECT_EQ(created.user().name(), "maria");
  EXPECT_TRUE(created.user().must_change_password());
  EXPECT_EQ(users_->CreateUser(ClientCall(admin).context(), create, &created).error_code(),
            grpc::StatusCode::ALREADY_EXISTS);

  pb::UpdateUserRequest promote;
  promote.set_name("maria");
  promote.set_role(pb::ROLE_ENGINEER);
  promote.set_etag(created.user().etag());
  pb::User user;
  ASSERT_TRUE(users_->UpdateUser(ClientCall(admin).context(), promote, &user).ok());
  EXPECT_EQ(user.role(), pb::ROLE_ENGINEER);
  EXPECT_EQ(user.full_name(), "María González");
  EXPECT_EQ(users_->UpdateUser(ClientCall(admin).context(), promote, &user).error_code(),
            grpc::StatusCode::ABORTED);
  promote.set_etag("seven");
  EXPECT_EQ(users_->UpdateUser(ClientCall(admin).context(), promote, &user).error_code(),
            grpc::StatusCode::INVALID_ARGUMENT);
  promote.set_role(pb::ROLE_UNSPECIFIED);
  EXPECT_EQ(users_->UpdateUser(ClientCall(admin).context(), promote, &user).error_code(),
            grpc::StatusCode::INVALID_ARGUMENT);

  pb::ResetPasswordRequest reset;
  reset.set_name("maria");
  pb::ResetPasswordResponse secret;
  ASSERT_TRUE(users_->ResetPassword(ClientCall(admin).context(), reset, &secret).ok());
  pb::LoginResponse login;
  EXPECT_FALSE(Login("maria", created.one_time_password(), &login).ok());
  EXPECT_TRUE(Login("maria", secret.one_time_password(), &login).ok());

  pb::DeleteUserRequest remove;
  remove.set_name("maria");
  pb::DeleteUserResponse removed;
  ASSERT_TRUE(users_->DeleteUser(ClientCall(admin).context(), remove, &removed).ok());
  EXPECT_EQ(WhoAmI(login.token()).error_code(), grpc::StatusCode::UNAUTHENTICATED);
  EXPECT_EQ(users_->DeleteUser(ClientCall(admin).context(), remove, &removed).error_code(),
            grpc::StatusCode::NOT_FOUND);
}

TEST_F(SessionServiceTest, AdministratorManagesApiKeys) {
  const std::string admin = server_.Token(Role::kAdmin);
  pb::CreateApiKeyRequest create;
  create.set_name("cell 7");
  create.set_role(pb::ROLE_ROBOT);
  create.mutable_expires()->set_seconds(1'700'000'000 + 3600);
  pb::CreateApiKeyResponse created;
  ASSERT_TRUE(users_->CreateApiKey(ClientCall(admin).context(), create, &created).ok());
  pb::WhoAmIResponse me;
  ASSERT_TRUE(WhoAmI(created.secret(), &me).ok());
  EXPECT_EQ(me.user(), "cell 7");
  EXPECT_EQ(me.expires().seconds(), 1'700'003'600);

  pb::ListApiKeysResponse list;
  ASSERT_TRUE(users_->ListApiKeys(ClientCall(admin).context(), {}, &list).ok());
  ASSERT_EQ(list.keys_size(), 1);
  EXPECT_EQ(list.keys(0).created_by(), "test.admin");
  EXPECT_TRUE(list.keys(0).has_last_used());

  pb::RevokeApiKeyRequest revoke;
  revoke.set_id(created.key().id());
  pb::RevokeApiKeyResponse revoked;
  ASSERT_TRUE(users_->RevokeApiKey(ClientCall(admin).context(), revoke, &revoked).ok());
  EXPECT_EQ(WhoAmI(created.secret()).error_code(), grpc::StatusCode::UNAUTHENTICATED);

  create.set_name("late");
  create.mutable_expires()->set_seconds(0);
  EXPECT_EQ(users_->CreateApiKey(ClientCall(admin).context(), create, &created).error_code(),
            grpc::StatusCode::INVALID_ARGUMENT);
  // What no clock can count.
  create.mutable_expires()->set_seconds(INT64_MAX);
  EXPECT_TRUE(users_->CreateApiKey(ClientCall(admin).context(), create, &created).ok());
}

TEST_F(SessionServiceTest, FloodOfLoginsIsBoundedAndOthersAreServed) {
  server_.AddUser("maria", Role::kViewer);
  const std::string token = TokenOf("maria", TestServer::kPassword);
  constexpr int kFlood = 200;
  std::vector<std::unique_ptr<ClientCall>> calls;
  std::vector<pb::LoginResponse> responses(kFlood);
  std::vector<grpc::Status> statuses(kFlood);
  std::atomic<int> pending{kFlood};
  pb::LoginRequest request;
  request.set_user("maria");
  request.set_password("a wrong one!");
  for (int i = 0; i < kFlood; ++i) {
    calls.push_back(std::make_unique<ClientCall>(""));
    sessions_->async()->Login(calls[i]->context(), &request, &responses[i],
                              [&, i](grpc::Status status) {
                                statuses[i] = std::move(status);
                                --pending;
                                pending.notify_all();
                              });
  }
  EXPECT_TRUE(WhoAmI(token).ok());
  for (int left = pending; left > 0; left = pending) pending.wait(left);
  for (const grpc::Status& status : statuses) {
    EXPECT_TRUE(status.error_code() == grpc::StatusCode::UNAUTHENTICATED ||
                status.error_code() == grpc::StatusCode::RESOURCE_EXHAUSTED)
        << status.error_message();
  }
  // The clock stands still: five failures, and the account is slowed down.
  EXPECT_EQ(server_->access().failed_logins(), 5U);
}

TEST_F(SessionServiceTest, LockedUserIsShownAndUnlocked) {
  const std::string admin = server_.Token(Role::kAdmin);
  server_.AddUser("maria", Role::kOperator);
  const std::string password = TestServer::kPassword;
  pb::LoginResponse login;
  for (int i = 0; i < 7; ++i) Login("maria", "wrong", &login);
  EXPECT_EQ(Login("maria", password, &login).error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);

  const auto listed = [&] {
    pb::ListUsersResponse users;
    EXPECT_TRUE(users_->ListUsers(ClientCall(admin).context(), {}, &users).ok());
    for (const pb::User& user : users.users()) {
      if (user.name() == "maria") return user;
    }
    return pb::User();
  };
  // The fifth failure locks for a second; the clock stands still, so there is no sixth.
  EXPECT_EQ(listed().locked_until().seconds(), clock_.UtcNs() / 1'000'000'000 + 1);

  pb::UnlockUserRequest request;
  request.set_name("Maria");
  pb::User user;
  EXPECT_EQ(users_->UnlockUser(ClientCall(login.token()).context(), request, &user).error_code(),
            grpc::StatusCode::UNAUTHENTICATED);
  ASSERT_TRUE(users_->UnlockUser(ClientCall(admin).context(), request, &user).ok());
  EXPECT_EQ(user.name(), "maria");
  EXPECT_FALSE(user.has_locked_until());
  EXPECT_FALSE(listed().has_locked_until());
  EXPECT_TRUE(Login("maria", password, &login).ok());

  request.set_name("nobody");
  EXPECT_EQ(users_->UnlockUser(ClientCall(admin).context(), request, &user).error_code(),
            grpc::StatusCode::NOT_FOUND);
}

}  // namespace
}  // namespace vs
