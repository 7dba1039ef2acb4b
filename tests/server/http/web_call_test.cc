// Calls over gRPC-Web, from raw sockets.

#include "server/http/web_call.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "visionserver/v1/error.pb.h"

#include "tests/server/http/http_fixture.h"
#include "tests/support/wait_until.h"

namespace vs::test {
namespace {

using std::chrono::milliseconds;
using std::string_literals::operator""s;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;
using ::testing::StartsWith;

// What our service answered.
std::string TokenIn(const WebFrames& frames) {
  pb::LoginResponse response;
  if (frames.messages.size() != 1 || !response.ParseFromString(frames.messages[0])) return "";
  return response.token();
}

std::string FromBase64(std::string_view text) {
  static constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  uint32_t bits = 0;
  unsigned count = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = (bits << 6U) | static_cast<uint32_t>(kDigits.find(c));
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>((bits >> count) & 0xffU);
  }
  return bytes;
}

class WebCallTest : public HttpBothTest {};

TEST_P(WebCallTest, AnswersAUnaryCall) {
  Start();
  const WebAnswer answer = Ask(WebPost(kLogin, LoginBytes("maria")));
  EXPECT_EQ(answer.status, 200);
  EXPECT_EQ(answer.headers.at("content-type"), "application/grpc-web+proto");
  EXPECT_EQ(answer.headers.at("cache-control"), "no-store");
  const WebFrames frames = FramesOf(answer.body);
  EXPECT_EQ(TokenIn(frames), "maria at 127.0.0.1 sent 0");
  EXPECT_THAT(frames.trailers, ElementsAre(std::pair("grpc-status", "0")));
}

TEST_P(WebCallTest, OneConnectionServesMany) {
  Start();
  WebClient client = Connect();
  for (size_t i = 0; i < 20; ++i) {
    client.Send(WebPost(kLogin, LoginBytes("maria", i * 5000)));
    EXPECT_EQ(TokenIn(FramesOf(client.Receive().value_or(WebAnswer()).body)),
              "maria at 127.0.0.1 sent " + std::to_string(i * 5000));
  }
  // Sent in one go, answered in turn.
  client.Send(WebPost(kLogin, LoginBytes("fail")) + WebRequest("GET", "/"));
  EXPECT_EQ(FramesOf(client.Receive()->body).trailers.at("grpc-status"), "5");
  EXPECT_EQ(client.Receive()->body, "<p>hello");
  EXPECT_EQ(server_->Connections().accepted, 1U);
}

TEST_P(WebCallTest, StreamsMessagesAsTheyCome) {
  Start();
  WebClient client = OpenStream();
  service_.numbers.Publish(7);
  ASSERT_TRUE(client.ReceiveHead().has_value());
  EXPECT_EQ(client.ReceiveChunk(),
            "\0\0\0\0\1"
            "7"s);
  service_.numbers.Publish(42);
  EXPECT_EQ(client.ReceiveChunk(),
            "\0\0\0\0\2"
            "42"s);
}

TEST_P(WebCallTest, ErrorInMidstreamComesInTheTrailers) {
  Start();
  WebClient client = OpenStream();
  service_.numbers.Publish(7);
  ASSERT_TRUE(client.ReceiveHead().has_value());
  ASSERT_TRUE(client.ReceiveChunk().has_value());
  service_.numbers.Publish(-1);
  const WebFrames end = FramesOf(client.ReceiveChunk().value_or(""));
  EXPECT_EQ(end.trailers.at("grpc-status"), "15");
  EXPECT_EQ(end.trailers.at("grpc-message"), "no more");
  EXPECT_EQ(client.ReceiveChunk(), std::nullopt);
  // The connection goes on.
  client.Send(WebPost(kLogin, LoginBytes("maria")));
  EXPECT_EQ(client.Receive()->status, 200);
}

TEST_P(WebCallTest, ErrorsCarryTheirTextAndDetails) {
  Start();
  const WebFrames frames = Call(WebPost(kLogin, LoginBytes("fail")));
  EXPECT_THAT(frames.messages, IsEmpty());
  EXPECT_EQ(frames.trailers.at("grpc-status"), "5");
  EXPECT_EQ(frames.trailers.at("grpc-message"), "Ger%C3%A4t fehlt zu 100 %25");
  pb::ErrorStatus details;
  ASSERT_TRUE(details.ParseFromString(FromBase64(frames.trailers.at("grpc-status-details-bin"))));
  EXPECT_EQ(details.message(), "Ger\xc3\xa4t fehlt zu 100 %");
  pb::ErrorDetail detail;
  ASSERT_TRUE(details.details(0).UnpackTo(&detail));
  EXPECT_EQ(detail.reason(), "CAMERA_GONE");
  EXPECT_EQ(detail.faults(0).subject(), "left");
}

TEST_P(WebCallTest, TheCredentialIsInTheMetadata) {
  Start();
  const std::string request = "\0\0\0\0\0"s;
  WebClient client = Connect();
  for (const WebHeaders& headers :
       {WebHeaders{}, WebHeaders{{"Authorization", "Bearer bad"}},
        WebHeaders{{"Authorization", "good"}}, WebHeaders{{"Authorization", "Basic good"}}}) {
    client.Send(WebPostBody(kLogin, request, headers));
    EXPECT_EQ(FramesOf(client.Receive()->body).trailers.at("grpc-status"), "16");
  }
  // A refused call leaves the connection as it was.
  client.Send(WebPostBody(kLogin, request, {{"AUTHORIZATION", "Bearer good"}}));
  EXPECT_EQ(FramesOf(client.Receive()->body).trailers.at("grpc-status"), "0");
  EXPECT_EQ(server_->Connections().accepted, 1U);
}

TEST_P(WebCallTest, KnowsItsClientsAddressAndBelievesNoOther) {
  Start();
  const WebHeaders claims = {{"X-Forwarded-For", "10.9.8.7"},
                             {"Forwarded", "for=10.9.8.7"},
                             {"X-Real-IP", "10.9.8.7"},
                             {"x-vs-client-address", "10.9.8.7"}};
  EXPECT_EQ(TokenIn(Call(WebPost(kLogin, LoginBytes("maria"), claims))),
            "maria at 127.0.0.1 sent 0");
}

TEST_P(WebCallTest, SaysWhichMethodItDoesNotHave) {
  Start();
  const WebFrames frames = Call(WebPost("/visionserver.v1.Nothing/AtAll?x=1", ""));
  EXPECT_EQ(frames.trailers.at("grpc-status"), "12");
  EXPECT_EQ(frames.trailers.at("grpc-message"),
            "there is no method /visionserver.v1.Nothing/AtAll");
}

TEST_P(WebCallTest, RefusesMalformedRequests) {
  Start();
  const std::vector<std::pair<std::string, std::string>> wrong = {
      {"", "3"},                          // no frame
      {"\0\0\0"s, "3"},                   // half a prefix
      {"\0\0\0\0\x9hello"s, "3"},         // more announced than there is
      {"\0\xff\xff\xff\xffhello"s, "3"},  // four gigabytes announced
      {"\0\0\0\0\0hello"s, "3"},          // more than announced
      {"\0\0\0\0\0\0\0\0\0\0"s, "3"},     // two messages
      {"\x80\0\0\0\0"s, "3"},             // trailers
      {"\1\0\0\0\5hello"s, "12"},         // compressed
      {"\0\0\0\0\2\x0a\x7f"s, "3"},       // no protobuf
  };
  WebClient client = Connect();
  for (const auto& [body, status] : wrong) {
    client.Send(WebPostBody(kLogin, body, {{"Authorization", "Bearer good"}}));
    const WebFrames frames = FramesOf(client.Receive().value_or(WebAnswer()).body);
    EXPECT_EQ(frames.trailers.at("grpc-status"), status) << ::testing::PrintToString(body);
    EXPECT_THAT(frames.trailers.at("grpc-message"), Not(IsEmpty()));
  }
  EXPECT_TRUE(Idle());
}

TEST_P(WebCallTest, RefusesAnOversizeRequestWithoutReadingIt) {
  options_.limits.calls.request_bytes = 100'000;
  Start();
  EXPECT_EQ(TokenIn(Call(WebPost(kLogin, LoginBytes("maria", 90'000)))),
            "maria at 127.0.0.1 sent 90000");
  WebClient client = Connect();
  client.Send(WebRequest("POST", kLogin,
                         {{"Content-Type", "application/grpc-web+proto"},
                          {"Content-Length", "18446744073709551615"},
                          {"Authorization", "Bearer good"}}));
  const auto answer = client.Receive();
  ASSERT_TRUE(answer.has_value());
  EXPECT_EQ(answer->headers.at("connection"), "close");
  const WebFrames frames = FramesOf(answer->body);
  EXPECT_EQ(frames.trailers.at("grpc-status"), "8");
  EXPECT_THAT(frames.trailers.at("grpc-message"), HasSubstr("takes at most 100000"));
  EXPECT_TRUE(client.ReceiveToEnd().has_value());
}

TEST_P(WebCallTest, RequestsTogetherHaveALimit) {
  options_.limits.calls.memory_bytes = 1000;
  Start();
  // One that takes its time has announced more than half of it.
  WebClient slow = Connect();
  const WebHeaders head = {{"Content-Type", "application/grpc-web+proto"},
                           {"Content-Length", "600"},
                           {"Authorization", "Bearer good"}};
  slow.Send(WebRequest("POST", kLogin, head));
  ASSERT_TRUE(WaitUntil([&] { return !dispatcher_->Idle(); }));
  std::string status;
  // It may not have got so far as to ask for its part yet.
  ASSERT_TRUE(WaitUntil([&] {
    status = Call(WebPost(kLogin, LoginBytes("maria", 500))).trailers["grpc-status"];
    return status == "8";
  }));
  EXPECT_EQ(TokenIn(Call(WebPost(kLogin, LoginBytes("maria", 100)))),
            "maria at 127.0.0.1 sent 100");
}

TEST_P(WebCallTest, EndsARequestThatComesTooSlowly) {
  options_.limits.calls.request_time = milliseconds(100);
  Start();
  WebClient client = Connect();
  client.Send(WebRequest("POST", kLogin,
                         {{"Content-Type", "application/grpc-web+proto"},
                          {"Content-Length", "600"},
                          {"Authorization", "Bearer good"}}) +
              "\0\0\0\2"s);
  const auto answer = client.Receive();
  ASSERT_TRUE(answer.has_value());
  EXPECT_EQ(FramesOf(answer->body).trailers.at("grpc-status"), "1");
  EXPECT_TRUE(client.ReceiveToEnd().has_value());
  EXPECT_TRUE(Idle());
}

TEST_P(WebCallTest, EndsAStreamAtItsDeadline) {
  Start();
  WebClient client = Connect();
  client.Send(WebPost(kWatch, "", {{"grpc-timeout", "50m"}}));
  const auto answer = client.Receive();
  ASSERT_TRUE(answer.has_value());
  EXPECT_EQ(FramesOf(answer->body).trailers.at("grpc-status"), "4");
  EXPECT_TRUE(Idle());
  EXPECT_EQ(service_.numbers.sources, 0);
  // The connection goes on.
  client.Send(WebPost(kLogin, LoginBytes("maria")));
  EXPECT_EQ(client.Receive()->status, 200);
}

TEST_P(WebCallTest, AnswersAtTheDeadlineWhateverTheHandlerDoes) {
  Start();
  WebClient client = Connect();
  client.Send(WebPost(kLogin, LoginBytes("wait"), {{"grpc-timeout", "50m"}}));
  const auto answer = client.Receive();
  ASSERT_TRUE(answer.has_value());
  EXPECT_EQ(FramesOf(answer->body).trailers.at("grpc-status"), "4");
  EXPECT_TRUE(client.ReceiveToEnd().has_value());
  EXPECT_FALSE(dispatcher_->Idle());
  service_.go_on.count_down();
  EXPECT_TRUE(Idle());
}

TEST_P(WebCallTest, RefusesATimeoutThatIsNone) {
  Start();
  const WebFrames frames = Call(WebPost(kLogin, "", {{"grpc-timeout", "soon"}}));
  EXPECT_EQ(frames.trailers.at("grpc-status"), "3");
  EXPECT_THAT(frames.trailers.at("grpc-message"), HasSubstr("\"soon\""));
}

TEST_P(WebCallTest, EndsTheCallWhenTheClientLeaves) {
  Start();
  {
    const WebClient waiting = OpenStream();
    EXPECT_EQ(service_.numbers.sources, 1);
  }
  EXPECT_TRUE(Idle());
  EXPECT_EQ(service_.numbers.sources, 0);
  {
    WebClient working = Connect();
    working.Send(WebPost(kLogin, LoginBytes("wait")));
    service_.waiting.wait();
  }
  service_.go_on.count_down();
  EXPECT_TRUE(Idle());
  EXPECT_TRUE(WaitUntil([&] { return server_->Connections().open == 0; }));
}

TEST_P(WebCallTest, EndsAStreamWhoseSessionIsRevoked) {
  Start();
  WebClient client = OpenStream();
  gate_.valid = false;
  const auto answer = client.Receive();
  ASSERT_TRUE(answer.has_value());
  EXPECT_EQ(FramesOf(answer->body).trailers.at("grpc-status"), "16");
}

TEST_P(WebCallTest, DrainEndsStreamsInOrder) {
  Start();
  WebClient client = OpenStream();
  // One whose request has not come whole.
  WebClient half = Connect();
  half.Send(WebRequest("POST", kLogin,
                       {{"Content-Type", "application/grpc-web+proto"},
                        {"Content-Length", "600"},
                        {"Authorization", "Bearer good"}}));
  ASSERT_TRUE(WaitUntil([&] { return dispatcher_->OpenStreams() == 1; }));
  dispatcher_->Drain();
  const auto answer = client.Receive();
  ASSERT_TRUE(answer.has_value());
  EXPECT_EQ(FramesOf(answer->body).trailers.at("grpc-status"), "14");
  const auto refused = half.Receive();
  ASSERT_TRUE(refused.has_value());
  EXPECT_EQ(FramesOf(refused->body).trailers.at("grpc-status"), "14");
  // Who comes later hears it, too.
  EXPECT_EQ(Call(WebPost(kLogin, LoginBytes("maria"))).trailers.at("grpc-status"), "14");
}

TEST_P(WebCallTest, CutsOffAStreamThatIsNotRead) {
  options_.limits.calls.unread.silence = milliseconds(100);
  Start();
  WebClient client = Connect();
  client.Send(WebPost(kWatch, WatchBytes("large")));
  ASSERT_TRUE(client.ReceiveHead().has_value());  // it has begun
  EXPECT_TRUE(Idle());
  EXPECT_TRUE(WaitUntil([&] { return server_->Connections().open == 0; }));
}

TEST_P(WebCallTest, LargeMessagesArriveWhole) {
  Start();
  WebClient client = Connect();
  client.Send(WebPost(kWatch, WatchBytes("large")));
  ASSERT_TRUE(client.ReceiveHead().has_value());
  for (int i = 0; i < 20; ++i) {
    const auto chunk = client.ReceiveChunk();
    ASSERT_TRUE(chunk.has_value());
    EXPECT_TRUE(*chunk == "\0\0\x10\0\0"s + std::string(1 << 20, 'x'));
  }
}

INSTANTIATE_TEST_SUITE_P(Both, WebCallTest,
                         ::testing::Values(WebClient::Tls::kOff, WebClient::Tls::kOn),
                         HttpBothTest::Name);

}  // namespace
}  // namespace vs::test
