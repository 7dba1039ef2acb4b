// The audit log over the real API: every change and every login leaves its entry.

#include <gmock/gmock.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <string_view>

#include "visionserver/v1/audit.grpc.pb.h"
#include "visionserver/v1/parameter.grpc.pb.h"
#include "visionserver/v1/sequence.grpc.pb.h"
#include "visionserver/v1/session.grpc.pb.h"

#include "server/access/policy.h"
#include "tests/support/client_call.h"
#include "tests/support/raw_call.h"
#include "tests/support/test_server.h"
#include "tests/support/wait_until.h"

namespace vs {
namespace {

namespace pb = visionserver::v1;
using test::ClientCall;
using test::TestServer;
using test::WaitUntil;
using ::testing::HasSubstr;
using ::testing::Not;

class AuditServiceTest : public ::testing::Test {
 protected:
  // An entry is written a moment after its call.
  pb::AuditEntry WaitFor(const std::string& user, const std::string& method) {
    pb::ListAuditEntriesRequest request;
    request.set_user(user);
    request.set_method(method);
    pb::ListAuditEntriesResponse response;
    EXPECT_TRUE(WaitUntil([&] {
      EXPECT_TRUE(audit_->ListAuditEntries(ClientCall(admin_).context(), request, &response).ok());
      return response.entries_size() > 0;
    })) << method;
    return response.entries_size() > 0 ? response.entries(0) : pb::AuditEntry();
  }
  grpc::Status Login(const std::string& user, const std::string& password) {
    pb::LoginRequest request;
    request.set_user(user);
    request.set_password(password);
    pb::LoginResponse response;
    return pb::SessionService::NewStub(channel_)->Login(ClientCall("").context(), request,
                                                        &response);
  }

  TestServer server_;
  std::shared_ptr<grpc::Channel> channel_ = server_.Connect();
  const std::string admin_ = server_.Token(Role::kAdmin);
  std::unique_ptr<pb::AuditService::Stub> audit_ = pb::AuditService::NewStub(channel_);
};

TEST_F(AuditServiceTest, EachMethodThatChangesSomethingLeavesAnEntry) {
  int methods = 0;
  for (const AccessRule& rule : AccessRules()) {
    if (!rule.changes) continue;
    ++methods;
    const std::string method(rule.method);
    // A new login each time: some of the methods end the session.
    const std::string token = rule.without_login ? "" : server_.Token(Role::kAdmin);
    const grpc::Status status = test::CallRaw(channel_, method, token).status;
    const pb::AuditEntry entry = WaitFor(rule.without_login ? "" : "test.admin", method);
    EXPECT_EQ(entry.method(), method);
    EXPECT_EQ(entry.address(), "127.0.0.1");
    EXPECT_EQ(entry.ok(), status.ok()) << method;
    EXPECT_EQ(entry.message(), status.error_message()) << method;
    EXPECT_GT(entry.time().seconds(), 0);
  }
  EXPECT_GE(methods, 19);
}

TEST_F(AuditServiceTest, WhatOnlyLooksLeavesNone) {
  const std::string viewer = server_.Token(Role::kViewer);
  for (const AccessRule& rule : AccessRules()) {
    const std::string_view name = rule.method.substr(rule.method.rfind('/') + 1);
    const bool stream = name.starts_with("Watch") || name == "Subscribe" ||
                        name == "ExportResults" || name == "ServerReflectionInfo";
    if (rule.changes || stream) continue;
    (void)test::CallRaw(channel_, std::string(rule.method), viewer);
  }
  server_.Restart();  // all is written
  channel_ = server_.Connect();
  audit_ = pb::AuditService::NewStub(channel_);
  pb::ListAuditEntriesResponse response;
  ASSERT_TRUE(audit_->ListAuditEntries(ClientCall(admin_).context(), {}, &response).ok());
  EXPECT_EQ(response.entries_size(), 0) << response.ShortDebugString();
}

TEST_F(AuditServiceTest, LoginsAreThereGoodAndBad) {
  server_.AddUser("maria", Role::kOperator);
  EXPECT_TRUE(Login("Maria", TestServer::kPassword).ok());
  pb::AuditEntry entry = WaitFor("maria", "Login");
  EXPECT_TRUE(entry.ok());
  EXPECT_FALSE(Login("maria", "my other password").ok());
  EXPECT_TRUE(WaitUntil([&] {
    entry = WaitFor("maria", "Login");
    return !entry.ok();
  }));
  EXPECT_EQ(entry.message(), "user name or password is wrong");
  EXPECT_FALSE(Login("my-password", "x").ok());
  server_.Restart();
  channel_ = server_.Connect();
  audit_ = pb::AuditService::NewStub(channel_);
  pb::ListAuditEntriesResponse all;
  ASSERT_TRUE(audit_->ListAuditEntries(ClientCall(admin_).context(), {}, &all).ok());
  EXPECT_EQ(all.entries_size(), 3);
  EXPECT_THAT(all.ShortDebugString(), Not(HasSubstr("password\"")));
  EXPECT_THAT(all.ShortDebugString(), Not(HasSubstr("my-password")));
}

TEST_F(AuditServiceTest, SaysWhoWasRefusedWhat) {
  const std::string viewer = server_.Token(Role::kViewer);
  pb::StartSequenceRequest start;
  start.set_id("stereo_depth");
  pb::SequenceState state;
  EXPECT_EQ(pb::SequenceService::NewStub(channel_)
                ->StartSequence(ClientCall(viewer).context(), start, &state)
                .error_code(),
            grpc::StatusCode::PERMISSION_DENIED);
  const pb::AuditEntry entry = WaitFor("test.viewer", "StartSequence");
  EXPECT_FALSE(entry.ok());
  EXPECT_THAT(entry.message(), HasSubstr("the role viewer may not call"));
}

TEST_F(AuditServiceTest, NamesWhatWasChangedButNotAMereCheck) {
  const auto parameters = pb::ParameterService::NewStub(channel_);
  pb::SetParametersRequest set;
  set.set_sequence("none");
  set.add_values()->set_path("checked.only");
  set.set_validate_only(true);
  pb::SetParametersResponse response;
  (void)parameters->SetParameters(ClientCall(admin_).context(), set, &response);
  set.set_validate_only(false);
  set.mutable_values(0)->set_path("match.p2");
  (void)parameters->SetParameters(ClientCall(admin_).context(), set, &response);
  EXPECT_EQ(WaitFor("test.admin", "SetParameters").subject(), "none: match.p2");
  pb::ListAuditEntriesRequest request;
  request.set_method("SetParameters");
  pb::ListAuditEntriesResponse entries;
  ASSERT_TRUE(audit_->ListAuditEntries(ClientCall(admin_).context(), request, &entries).ok());
  EXPECT_EQ(entries.entries_size(), 1);
}

TEST_F(AuditServiceTest, ComesInPagesForAdministrators) {
  for (int i = 0; i < 5; ++i) (void)Login("nobody", "x");
  server_.Restart();
  channel_ = server_.Connect();
  audit_ = pb::AuditService::NewStub(channel_);
  pb::ListAuditEntriesRequest request;
  request.set_page_size(2);
  std::set<uint64_t> numbers;
  int pages = 0;
  do {
    pb::ListAuditEntriesResponse page;
    ASSERT_TRUE(audit_->ListAuditEntries(ClientCall(admin_).context(), request, &page).ok());
    for (const pb::AuditEntry& entry : page.entries()) {
      EXPECT_TRUE(numbers.empty() || entry.number() < *numbers.begin()) << "newest first";
      numbers.insert(entry.number());
    }
    request.set_page_token(page.next_page_token());
    ++pages;
  } while (!request.page_token().empty());
  EXPECT_EQ(numbers.size(), 5u);
  EXPECT_EQ(pages, 3);

  pb::ListAuditEntriesResponse page;
  request.set_page_size(1001);
  EXPECT_EQ(audit_->ListAuditEntries(ClientCall(admin_).context(), request, &page).error_code(),
            grpc::StatusCode::INVALID_ARGUMENT);
  request.set_page_size(0);
  request.set_page_token("x");
  EXPECT_EQ(audit_->ListAuditEntries(ClientCall(admin_).context(), request, &page).error_code(),
            grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(
      audit_->ListAuditEntries(ClientCall(server_.Token(Role::kEngineer)).context(), {}, &page)
          .error_code(),
      grpc::StatusCode::PERMISSION_DENIED);
}

}  // namespace
}  // namespace vs
