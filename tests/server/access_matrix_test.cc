// Every method of every service, called over the network without a token and with each role.

#include <gmock/gmock.h>
#include <google/protobuf/descriptor.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <atomic>
#include <fstream>
#include <set>
#include <thread>

#include <google/protobuf/descriptor.pb.h>

#include "engine/base/str.h"
#include "server/access/policy.h"
#include "tests/support/raw_call.h"
#include "tests/support/test_server.h"
#include "tests/support/wait_until.h"

namespace vs {
namespace {

using ::testing::ElementsAreArray;
using ::testing::UnorderedElementsAreArray;

struct DeclaredMethod {
  std::string name;
  bool client_streaming = false;
  bool server_streaming = false;
};

// From all .proto files of the source tree, whatever code is linked into this test.
std::vector<DeclaredMethod> DeclaredMethods() {
  std::ifstream file(VS_DESCRIPTOR_SET, std::ios::binary);
  google::protobuf::FileDescriptorSet set;
  if (!set.ParseFromIstream(&file)) throw std::runtime_error("no descriptors");
  std::vector<DeclaredMethod> methods;
  for (const auto& proto : set.file()) {
    for (const auto& service : proto.service()) {
      for (const auto& method : service.method()) {
        methods.push_back({Str("/", proto.package(), ".", service.name(), "/", method.name()),
                           method.client_streaming(), method.server_streaming()});
      }
    }
  }
  return methods;
}

std::vector<std::string> Names(const std::vector<DeclaredMethod>& methods) {
  std::vector<std::string> names;
  names.reserve(methods.size());
  for (const DeclaredMethod& method : methods) names.push_back(method.name);
  return names;
}

class AccessMatrixTest : public ::testing::Test {
 protected:
  // What the gate says; anything that lies behind it counts as OK.
  grpc::StatusCode Gate(const DeclaredMethod& method, const std::string& token) {
    grpc::Status status;
    if (method.server_streaming) {
      // A stream that is let in may have nothing to say: it is let in when it is open.
      test::RawCall call(channel_, method.name, token);
      if (call.Send("") && !method.client_streaming) call.CloseRequests();
      std::optional<std::string> first;
      std::atomic<bool> heard{false};
      std::jthread reader([&] {
        first = call.Receive();
        heard = true;
      });
      const auto open = [&] { return server_->dispatcher().OpenStreams() > 0; };
      EXPECT_TRUE(test::WaitUntil([&] { return heard || open(); })) << method.name;
      const bool silent = !heard;
      if (silent) call.Cancel();
      reader.join();
      if (first) call.Cancel();
      status = call.Finish();
      // The client may be done first: the next method must not be taken for this one.
      EXPECT_TRUE(test::WaitUntil([&] { return !open(); })) << method.name;
      if (silent) return grpc::StatusCode::OK;
    } else {
      status = test::CallRaw(channel_, method.name, token).status;
    }
    const bool denied = status.error_code() == grpc::StatusCode::UNAUTHENTICATED ||
                        status.error_code() == grpc::StatusCode::PERMISSION_DENIED;
    // An empty login is refused for its emptiness, not for what it may not.
    return denied ? status.error_code() : grpc::StatusCode::OK;
  }

  test::TestServer server_{{.config = "profile: DEVELOPMENT"}};
  std::shared_ptr<grpc::Channel> channel_ = server_.Connect();
  const std::vector<DeclaredMethod> methods_ = DeclaredMethods();
};

TEST_F(AccessMatrixTest, TableHasEveryMethodOnce) {
  std::vector<std::string> ruled;
  for (const AccessRule& rule : AccessRules()) ruled.emplace_back(rule.method);
  EXPECT_THAT(ruled, UnorderedElementsAreArray(Names(methods_)));
}

TEST_F(AccessMatrixTest, WithoutATokenOnlyThreeMethodsAnswer) {
  std::set<std::string> answering;
  for (const DeclaredMethod& method : methods_) {
    const grpc::StatusCode code = Gate(method, "");
    if (code == grpc::StatusCode::OK) {
      answering.insert(method.name);
    } else {
      EXPECT_EQ(code, grpc::StatusCode::UNAUTHENTICATED) << method.name;
    }
  }
  EXPECT_THAT(answering, ElementsAreArray({"/grpc.health.v1.Health/Check",
                                           "/visionserver.v1.SessionService/Login",
                                           "/visionserver.v1.SystemService/GetServerInfo"}));
}

TEST_F(AccessMatrixTest, WithAWrongTokenNoneBeyondThoseAnswers) {
  for (const DeclaredMethod& method : methods_) {
    const bool open = FindAccessRule(method.name)->without_login;
    EXPECT_EQ(Gate(method, "vst_AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA"),
              open ? grpc::StatusCode::OK : grpc::StatusCode::UNAUTHENTICATED)
        << method.name;
  }
}

TEST_F(AccessMatrixTest, EachRoleReachesExactlyWhatTheTableGivesIt) {
  int cells = 0;
  for (const Role role :
       {Role::kViewer, Role::kOperator, Role::kEngineer, Role::kAdmin, Role::kRobot}) {
    for (const DeclaredMethod& method : methods_) {
      // A new login each time: some of the methods end the session.
      const std::string token = server_.Token(role);
      const bool allowed = FindAccessRule(method.name)->roles.Contains(role) ||
                           FindAccessRule(method.name)->without_login;
      EXPECT_EQ(Gate(method, token),
                allowed ? grpc::StatusCode::OK : grpc::StatusCode::PERMISSION_DENIED)
          << RoleName(role) << " " << method.name;
      ++cells;
    }
  }
  EXPECT_EQ(cells, 5 * static_cast<int>(methods_.size()));
}

TEST_F(AccessMatrixTest, OneTimePasswordReachesNothingButItsChange) {
  const std::string one_time =
      *server_->access().accounts().CreateUser({.name = "newcomer", .role = Role::kAdmin});
  const std::string token = server_->access().LogIn("newcomer", one_time, "127.0.0.1", "")->token;
  for (const DeclaredMethod& method : methods_) {
    // Last, since it ends the session.
    if (method.name == "/visionserver.v1.SessionService/Logout") continue;
    EXPECT_EQ(Gate(method, token), FindAccessRule(method.name)->before_password_change
                                       ? grpc::StatusCode::OK
                                       : grpc::StatusCode::PERMISSION_DENIED)
        << method.name;
  }
}

TEST_F(AccessMatrixTest, UnknownMethodTellsStrangersNothing) {
  EXPECT_EQ(
      test::CallRaw(channel_, "/visionserver.v1.SessionService/Backdoor", "").status.error_code(),
      grpc::StatusCode::UNAUTHENTICATED);
  EXPECT_EQ(test::CallRaw(channel_, "/visionserver.v1.SessionService/Backdoor",
                          server_.Token(Role::kViewer))
                .status.error_code(),
            grpc::StatusCode::UNIMPLEMENTED);
}

}  // namespace
}  // namespace vs
