#include "server/rpc/router.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "visionserver/v1/sequence.pb.h"
#include "visionserver/v1/session.pb.h"

#include "engine/base/check.h"
#include "engine/base/str.h"

namespace vs {
namespace {

namespace pb = visionserver::v1;
using ::testing::HasSubstr;

class EchoService {
 public:
  Result<pb::LoginResponse> Login(const Call& call, const pb::LoginRequest& request) {
    if (request.user() == "nobody") return NotFound("nobody here");
    pb::LoginResponse response;
    response.set_token(Str(request.user(), " from ", call.address));
    return response;
  }
  Result<pb::LogoutResponse> Logout(const Call& /*call*/, const pb::LogoutRequest& /*request*/) {
    return pb::LogoutResponse();
  }
};

std::string Bytes(const WireMessage& message) {
  std::string bytes;
  for (const WireSlice& slice : message) {
    bytes.append(static_cast<const char*>(slice.data), slice.size_bytes);
  }
  return bytes;
}

constexpr const char* kLogin = "/visionserver.v1.SessionService/Login";

TEST(Router, TurnsBytesIntoMessagesAndBack) {
  EchoService service;
  Router router;
  router.Unary(kLogin, &service, &EchoService::Login);
  const Method* method = router.Find(kLogin);
  ASSERT_NE(method, nullptr);
  EXPECT_FALSE(method->server_streaming);

  pb::LoginRequest request;
  request.set_user("maria");
  const auto answer = method->answer({.address = "10.0.0.1"}, request.SerializeAsString());
  ASSERT_TRUE(answer.has_value());
  pb::LoginResponse response;
  ASSERT_TRUE(response.ParseFromString(Bytes(*answer)));
  EXPECT_EQ(response.token(), "maria from 10.0.0.1");
}

TEST(Router, HandsErrorsOn) {
  EchoService service;
  Router router;
  router.Unary(kLogin, &service, &EchoService::Login);
  pb::LoginRequest request;
  request.set_user("nobody");
  EXPECT_EQ(router.Find(kLogin)->answer({}, request.SerializeAsString()).error(),
            NotFound("nobody here"));
}

TEST(Router, RefusesBytesThatAreNoMessage) {
  EchoService service;
  Router router;
  router.Unary(kLogin, &service, &EchoService::Login);
  const Method* method = router.Find(kLogin);
  // A field that claims to be longer than the message, and a name that is not UTF-8.
  for (const std::string& bytes : {std::string("\x0a\x7f"), std::string("\x0a\x02\xff\xfe")}) {
    const auto answer = method->answer({}, bytes);
    ASSERT_FALSE(answer.has_value());
    EXPECT_EQ(answer.error().code(), StatusCode::kInvalidArgument);
    EXPECT_THAT(answer.error().message(), HasSubstr("visionserver.v1.LoginRequest"));
  }
}

TEST(Router, DoesNotKnowOtherMethods) {
  const Router router;
  EXPECT_EQ(router.Find(kLogin), nullptr);
  EXPECT_EQ(router.Find(""), nullptr);
}

TEST(Router, RefusesHandlersThatDoNotFitTheirDeclaration) {
  EchoService service;
  Router router;
  EXPECT_THROW(
      router.Unary("/visionserver.v1.SessionService/Nothing", &service, &EchoService::Login),
      BrokenInvariant);
  EXPECT_THROW(router.Unary(kLogin, &service, &EchoService::Logout), BrokenInvariant);
  router.Unary(kLogin, &service, &EchoService::Login);
  EXPECT_THROW(router.Unary(kLogin, &service, &EchoService::Login), BrokenInvariant);
}

}  // namespace
}  // namespace vs
