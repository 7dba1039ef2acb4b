// What a connection takes and what it refuses, from raw sockets.

#include "server/http/http_connection.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <random>

#include "tests/server/http/http_fixture.h"
#include "tests/support/wait_until.h"

namespace vs::test {
namespace {

using std::chrono::milliseconds;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

// Of this whole process.
size_t MemoryInUseBytes() {
  std::ifstream file("/proc/self/statm");
  size_t total = 0;
  size_t resident = 0;
  file >> total >> resident;
  return resident * 4096;
}

class HttpConnectionTest : public HttpBothTest {};

TEST_P(HttpConnectionTest, ServesThePage) {
  std::ofstream(folder_ / "web/assets/app.js") << "let a;";
  std::ofstream(folder_ / "web/assets/app.js.gz") << "packed";
  Start();
  WebClient client = Connect();
  client.Send(WebRequest("GET", "/overview"));
  EXPECT_EQ(client.Receive()->body, "<p>hello");
  client.Send(WebRequest("GET", "/assets/app.js", {{"Accept-Encoding", "gzip"}}));
  const WebAnswer packed = client.Receive().value();
  EXPECT_EQ(packed.body, "packed");
  EXPECT_EQ(packed.headers.at("content-encoding"), "gzip");
  client.Send(
      WebRequest("GET", "/assets/app.js",
                 {{"If-None-Match", packed.headers.at("etag")}, {"Accept-Encoding", "gzip"}}));
  EXPECT_EQ(client.Receive(false)->status, 304);
  client.Send(WebRequest("HEAD", "/assets/app.js"));
  EXPECT_EQ(client.Receive(false)->headers.at("content-length"), "6");
  client.Send(WebRequest("GET", "/../secret"));
  EXPECT_EQ(client.Receive()->status, 404);
  EXPECT_EQ(server_->Connections().accepted, 1U);
}

TEST_P(HttpConnectionTest, TellsTheBrowserWhatThePageMayDo) {
  Start();
  for (const std::string& request :
       {WebRequest("GET", "/"), WebRequest("GET", "/none.js"), WebRequest("PUT", "/"),
        WebPost(kLogin, LoginBytes("maria")), WebPost(kLogin, "", {{"Origin", "https://evil"}}),
        std::string("nonsense\r\n\r\n")}) {
    const WebAnswer answer = Ask(request);
    const auto header = [&](const std::string& name) {
      return answer.headers.contains(name) ? answer.headers.at(name) : "none";
    };
    EXPECT_THAT(header("content-security-policy"),
                AllOf(StartsWith("default-src 'self';"), HasSubstr("frame-ancestors 'none'"),
                      HasSubstr("base-uri 'none'"), HasSubstr("form-action 'none'"),
                      HasSubstr("script-src 'self';"), HasSubstr("connect-src 'self';")))
        << request;
    EXPECT_EQ(header("x-content-type-options"), "nosniff");
    EXPECT_EQ(header("referrer-policy"), "same-origin");
    EXPECT_EQ(header("access-control-allow-origin"), "none");
  }
}

TEST_P(HttpConnectionTest, TakesCallsOfItsOwnPageOnly) {
  Start();
  const auto status_from = [&](const std::string& origin, const std::string& host) {
    return Ask(WebPost(kLogin, LoginBytes("maria"), {{"Origin", origin}, {"Host", host}})).status;
  };
  EXPECT_EQ(status_from("https://vision.example:8443", "vision.example:8443"), 200);
  EXPECT_EQ(status_from("https://Vision.Example", "vision.example"), 200);
  EXPECT_EQ(status_from("https://evil.example", "vision.example"), 403);
  EXPECT_EQ(status_from("https://vision.example:444", "vision.example"), 403);
  EXPECT_EQ(status_from("https://vision.example.evil", "vision.example"), 403);
  EXPECT_EQ(status_from("https://evil/vision.example", "vision.example"), 403);
  EXPECT_EQ(status_from("null", "null"), 403);
  EXPECT_EQ(status_from("vision.example", "vision.example"), 403);
  EXPECT_TRUE(dispatcher_->Idle());
}

TEST_P(HttpConnectionTest, GrantsNothingToOtherOrigins) {
  Start();
  const WebAnswer answer = Ask(WebRequest(
      "OPTIONS", kLogin, {{"Origin", "https://evil"}, {"Access-Control-Request-Method", "POST"}}));
  EXPECT_EQ(answer.status, 405);
  EXPECT_EQ(answer.headers.at("allow"), "GET, HEAD, POST");
  for (const auto& [name, value] : answer.headers) {
    EXPECT_FALSE(name.starts_with("access-control")) << name;
  }
}

TEST_P(HttpConnectionTest, SaysWhichCallsItTakes) {
  Start();
  for (const char* type : {"application/grpc-web-text", "application/grpc", "application/json",
                           "application/x-www-form-urlencoded", "text/plain"}) {
    const WebAnswer answer =
        Ask(WebRequest("POST", kLogin, {{"Content-Type", type}, {"Content-Length", "0"}}));
    EXPECT_EQ(answer.status, 415) << type;
    EXPECT_THAT(answer.body, AllOf(HasSubstr("application/grpc-web+proto"), HasSubstr(type)));
  }
}

TEST_P(HttpConnectionTest, RefusesWhatIsNoRequest) {
  Start();
  const std::vector<std::pair<std::string, int>> wrong = {
      {"nonsense\r\n\r\n", 400},
      {"GET / HTTP/1.0\r\n\r\n", 505},
      {"GET http://evil/ HTTP/1.1\r\nHost: x\r\n\r\n", 400},
      {"GET / HTTP/1.1\r\nbad header\r\n\r\n", 400},
      {"POST / HTTP/1.1\r\nContent-Length: many\r\n\r\n", 400},
      {"POST / HTTP/1.1\r\nContent-Length: 1\r\nContent-Length: 2\r\n\r\n", 400},
      {"POST / HTTP/1.1\r\nContent-Length: 1\r\nTransfer-Encoding: chunked\r\n\r\n", 400},
      {"POST / HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n", 411},
      {"GET /" + std::string(9000, 'x') + " HTTP/1.1\r\n\r\n", 431},
      {"GET / HTTP/1.1\r\nX: " + std::string(9000, 'x') + "\r\n\r\n", 431},
      {"GET / HTTP/1.1\r\nX: " + std::string(100'000, 'x'), 431}};
  for (const auto& [request, status] : wrong) {
    WebClient client = Connect();
    client.Send(request);
    const auto answer = client.Receive();
    ASSERT_TRUE(answer.has_value()) << request.substr(0, 60);
    EXPECT_EQ(answer->status, status) << request.substr(0, 60);
    EXPECT_EQ(answer->headers.at("connection"), "close");
    EXPECT_TRUE(client.ReceiveToEnd().has_value());
  }
  EXPECT_EQ(Ask(WebRequest("GET", "/")).status, 200);
}

TEST_P(HttpConnectionTest, TakesAHeadUpToTheLimit) {
  Start();
  EXPECT_EQ(Ask(WebRequest("GET", "/", {{"X", std::string(8000, 'x')}})).status, 200);
  EXPECT_EQ(Ask(WebRequest("GET", "/", {{"X", std::string(8192, 'x')}})).status, 431);
}

TEST_P(HttpConnectionTest, GarbageTakesNoMemory) {
  Start();
  const std::string garbage(1 << 20, 'x');
  const size_t before = MemoryInUseBytes();
  size_t sent = 0;
  while (sent < (size_t{300} << 20)) {
    WebClient client = Connect();
    // As much as the server takes: some of it, until it hangs up.
    for (int i = 0; i < 300 && client.Send(garbage); ++i) sent += garbage.size();
    sent += garbage.size();
  }
  const size_t after = MemoryInUseBytes();
#ifndef __SANITIZE_ADDRESS__  // which keeps up to 256 MiB of what was freed
  EXPECT_LT(after, before + (size_t{64} << 20));
#else
  static_cast<void>(before < after);
#endif
  EXPECT_EQ(Ask(WebRequest("GET", "/")).status, 200);
}

TEST_P(HttpConnectionTest, EndsAHeadThatDrips) {
  options_.limits.head = milliseconds(200);
  Start();
  WebClient client = Connect();
  client.Send("GET / HTTP/1.1\r\n");
  // A byte now and then keeps nothing alive. It would take minutes to come to the end.
  while (client.Send("x")) std::this_thread::sleep_for(milliseconds(10));
  EXPECT_TRUE(WaitUntil([&] { return server_->Connections().open == 0; }));
}

TEST_P(HttpConnectionTest, SaysThatAHeadCameTooSlowly) {
  options_.limits.head = milliseconds(100);
  Start();
  WebClient client = Connect();
  client.Send("GET / HTTP/1.1\r\nHost: x\r\n");
  EXPECT_EQ(client.Receive().value_or(WebAnswer()).status, 408);
  EXPECT_TRUE(client.ReceiveToEnd().has_value());
}

TEST_P(HttpConnectionTest, ClosesConnectionsThatAskForNothing) {
  options_.limits.head = milliseconds(100);
  Start();
  EXPECT_EQ(Connect().ReceiveToEnd(), "");
}

TEST_P(HttpConnectionTest, ClosesConnectionsThatAskForNoMore) {
  options_.limits.idle = milliseconds(100);
  Start();
  WebClient client = Connect();
  client.Send(WebRequest("GET", "/"));
  EXPECT_EQ(client.Receive()->status, 200);
  EXPECT_EQ(client.ReceiveToEnd(), "");
}

TEST_P(HttpConnectionTest, ClosesWhenAskedTo) {
  Start();
  WebClient client = Connect();
  client.Send(WebRequest("GET", "/", {{"Connection", "close"}}));
  const auto answer = client.Receive();
  ASSERT_TRUE(answer.has_value());
  EXPECT_EQ(answer->headers.at("connection"), "close");
  EXPECT_EQ(client.ReceiveToEnd(), "");
  WebClient caller = Connect();
  caller.Send(WebPost(kLogin, LoginBytes("maria"), {{"Connection", "close"}}));
  EXPECT_EQ(caller.Receive()->headers.at("connection"), "close");
  EXPECT_EQ(caller.ReceiveToEnd(), "");
}

TEST_P(HttpConnectionTest, CutsOffAFileThatIsNotRead) {
  std::ofstream(folder_ / "web/large.txt") << std::string(size_t{32} << 20, 'x');
  options_.limits.file.silence = milliseconds(100);
  Start();
  WebClient client = Connect();
  client.Send(WebRequest("GET", "/large.txt"));
  EXPECT_TRUE(WaitUntil([&] { return server_->Connections().accepted == 1; }));
  EXPECT_TRUE(WaitUntil([&] { return server_->Connections().open == 0; }));
}

TEST_P(HttpConnectionTest, SurvivesRandomRequests) {
  options_.limits.head = milliseconds(50);
  options_.limits.idle = milliseconds(50);
  options_.limits.calls.request_time = milliseconds(50);
  Start();
  std::mt19937 random(5);
  const std::vector<std::string> proper = {
      WebRequest("GET", "/"), WebPost(kLogin, LoginBytes("maria", 300)),
      WebPost(kLogin, LoginBytes("fail"), {{"grpc-timeout", "1S"}, {"Origin", "https://a"}}),
      WebRequest("HEAD", "/assets/%41?x",
                 {{"If-None-Match", "\"a\""}, {"Accept-Encoding", "gzip"}})};
  for (int i = 0; i < 300; ++i) {
    std::string bytes = proper[random() % proper.size()] + proper[random() % proper.size()];
    // Some bytes changed, inserted or gone.
    for (size_t changes = random() % 8; changes > 0 && !bytes.empty(); --changes) {
      const size_t at = random() % bytes.size();
      const auto byte = static_cast<char>(random());
      switch (random() % 4) {
        case 0:
          bytes[at] = byte;
          break;
        case 1:
          bytes.insert(at, random() % 100, byte);
          break;
        case 2:
          bytes.erase(at, random() % 20);
          break;
        default:
          bytes.resize(at + 1);
      }
    }
    WebClient client = Connect();
    client.Send(bytes);
    // Half of them leave at once, the others look at what comes.
    if (i % 2 == 0) {
      EXPECT_TRUE(client.ReceiveToEnd().has_value());
    }
  }
  EXPECT_TRUE(Idle());
  EXPECT_TRUE(WaitUntil([&] { return server_->Connections().open == 0; }));
}

INSTANTIATE_TEST_SUITE_P(Both, HttpConnectionTest,
                         ::testing::Values(WebClient::Tls::kOff, WebClient::Tls::kOn),
                         HttpBothTest::Name);

}  // namespace
}  // namespace vs::test
