// The listener: limits of connections, TLS, and how it ends.

#include "server/http/http_server.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/server/http/http_fixture.h"
#include "tests/support/raw_socket.h"
#include "tests/support/wait_until.h"

namespace vs::test {
namespace {

using std::chrono::hours;
using std::chrono::milliseconds;
using ::testing::HasSubstr;

// Whether the kernel will ask the client on `port` of this machine for a sign of life.
bool KernelWatches(uint16_t port) {
  std::ifstream connections("/proc/net/tcp");
  std::string line;
  while (std::getline(connections, line)) {
    std::istringstream fields(line);
    std::string number;
    std::string local;
    std::string remote;
    std::string state;
    std::string queues;
    std::string timer;
    fields >> number >> local >> remote >> state >> queues >> timer;
    const size_t colon = local.find(':');
    if (colon == std::string::npos || state != "01") continue;
    // "02": the timer that runs is the one for keep-alive.
    if (std::stoul(local.substr(colon + 1), nullptr, 16) == port) return timer.starts_with("02:");
  }
  return false;
}

class HttpServerTest : public HttpTest {};

TEST_F(HttpServerTest, AsksClientsOfSilentStreamsForASignOfLife) {
  Start();
  const WebClient client = OpenStream();
  EXPECT_TRUE(WaitUntil([&] { return KernelWatches(server_->port()); }));
}

TEST_F(HttpServerTest, KeepsToItsLimitOfConnections) {
  options_.acceptor.max_connections_per_address = 3;
  Start();
  std::vector<WebClient> clients;
  for (int i = 0; i < 3; ++i) clients.push_back(Connect());
  EXPECT_TRUE(WaitUntil([&] { return server_->Connections().accepted == 3; }));
  EXPECT_EQ(Connect().ReceiveToEnd(), "");
  EXPECT_EQ(server_->Connections().refused, 1U);
  clients.clear();
  EXPECT_TRUE(WaitUntil([&] { return server_->Connections().open == 0; }));
  EXPECT_EQ(Ask(WebRequest("GET", "/")).status, 200);

  options_.acceptor = {.address = {.host = "127.0.0.1"}, .max_connections = 1};
  Start();
  const WebClient only = Connect();
  EXPECT_TRUE(WaitUntil([&] { return server_->Connections().accepted == 1; }));
  EXPECT_EQ(Connect().ReceiveToEnd(), "");
}

TEST_F(HttpServerTest, SurvivesAStormOfConnections) {
  for (const WebClient::Tls tls : {WebClient::Tls::kOff, WebClient::Tls::kOn}) {
    options_.acceptor.max_connections_per_address = 256;
    Start(tls);
    std::vector<std::jthread> storm;
    for (int thread = 0; thread < 4; ++thread) {
      storm.emplace_back([this, thread] {
        for (int i = 0; i < 25; ++i) {
          WebClient client = Connect();
          if (thread == 0) client.Send("GET / HT");
          if (thread == 1) client.Send(WebPost(kWatch, ""));
          if (thread == 2) {
            client.Send(WebPost(kLogin, LoginBytes("maria")));
            EXPECT_EQ(client.Receive().value_or(WebAnswer()).status, 200);
          }
        }
      });
    }
    storm.clear();
    EXPECT_TRUE(WaitUntil([&] { return server_->Connections().open == 0; }));
    EXPECT_TRUE(Idle());
    EXPECT_EQ(Ask(WebRequest("GET", "/")).status, 200);
  }
}

TEST_F(HttpServerTest, StopEndsWhoIsWaiting) {
  for (const WebClient::Tls tls : {WebClient::Tls::kOff, WebClient::Tls::kOn}) {
    Start(tls);
    WebClient idle = Connect();
    idle.Send(WebRequest("GET", "/"));
    ASSERT_TRUE(idle.Receive().has_value());
    WebClient half = Connect();
    half.Send("GET / HT");
    RawSocket silent(server_->port());
    EXPECT_TRUE(WaitUntil([&] { return server_->Connections().accepted == 3; }));
    // It would hold for hours if one of them did.
    server_->Stop(hours(1));
    EXPECT_EQ(idle.ReceiveToEnd(), "");
    EXPECT_TRUE(half.ReceiveToEnd().has_value());
    EXPECT_TRUE(silent.WaitForClose());
  }
}

TEST_F(HttpServerTest, StopLetsAnAnswerUnderWayEnd) {
  Start();
  WebClient client = Connect();
  client.Send(WebPost(kLogin, LoginBytes("wait")));
  service_.waiting.wait();
  std::jthread stopping([&] { server_->Stop(hours(1)); });
  service_.go_on.count_down();
  EXPECT_EQ(client.Receive().value_or(WebAnswer()).status, 200);
  EXPECT_EQ(client.ReceiveToEnd(), "");
}

TEST_F(HttpServerTest, StopCutsOffWhatDoesNotEnd) {
  Start();
  WebClient reading = Connect();
  reading.Send(WebPost(kWatch, WatchBytes("large")));
  ASSERT_TRUE(reading.ReceiveHead().has_value());
  WebClient waiting = OpenStream();
  server_->Stop(milliseconds(50));
  EXPECT_TRUE(reading.ReceiveToEnd().has_value());
  EXPECT_EQ(waiting.ReceiveToEnd(), "");
  EXPECT_TRUE(Idle());
  EXPECT_EQ(service_.numbers.sources, 0);
}

TEST_F(HttpServerTest, ClosesTlsConnectionsThatNeverFinishTheirHandshake) {
  options_.limits.handshake = milliseconds(100);
  Start(WebClient::Tls::kOn);
  RawSocket silent(server_->port());
  RawSocket half(server_->port());
  half.Send(std::string("\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03", 11));
  RawSocket garbage(server_->port());
  garbage.Send("\x16 no TLS at all");
  EXPECT_TRUE(silent.WaitForClose());
  EXPECT_TRUE(half.WaitForClose());
  EXPECT_TRUE(garbage.WaitForClose());
}

TEST_F(HttpServerTest, TellsWhoForgotTheS) {
  Start(WebClient::Tls::kOn);
  WebClient plain(server_->port(), WebClient::Tls::kOff);
  plain.Send(WebRequest("GET", "/overview?x=1", {{"Host", "vision.example:8443"}}));
  const WebAnswer answer = plain.Receive().value_or(WebAnswer());
  EXPECT_EQ(answer.status, 307);
  EXPECT_EQ(answer.headers.at("location"), "https://vision.example:8443/overview?x=1");
  EXPECT_EQ(plain.ReceiveToEnd(), "");
  // A call's credential is out already: it is not sent on.
  WebClient caller(server_->port(), WebClient::Tls::kOff);
  caller.Send(WebPost(kLogin, LoginBytes("maria")));
  const WebAnswer refused = caller.Receive().value_or(WebAnswer());
  EXPECT_EQ(refused.status, 400);
  EXPECT_THAT(refused.body, HasSubstr("https://"));
  EXPECT_FALSE(refused.headers.contains("location"));
}

TEST_F(HttpServerTest, TakesANewCertificateWithoutARestart) {
  Start(WebClient::Tls::kOn);
  const std::string before = Connect().Fingerprint();
  EXPECT_EQ(before, CheckCertificate(*options_.certificate)->fingerprint);
  const CertificateFiles fresh = *EnsureCertificate(folder_ / "fresh");
  std::filesystem::rename(fresh.key, options_.certificate->key);
  std::filesystem::rename(fresh.certificate, options_.certificate->certificate);
  const std::string fingerprint = CheckCertificate(*options_.certificate)->fingerprint;
  EXPECT_NE(fingerprint, before);
  EXPECT_TRUE(WaitUntil([&] { return Connect().Fingerprint() == fingerprint; }));
}

TEST_F(HttpServerTest, PlainTextIsForThisMachineOnly) {
  Start();
  options_.acceptor.address = {.host = "0.0.0.0"};
  const auto refused = HttpServer::Start(options_, *dispatcher_);
  ASSERT_FALSE(refused.has_value());
  EXPECT_THAT(refused.error().message(), HasSubstr("use TLS"));
}

TEST_F(HttpServerTest, SaysWhenItsCertificateIsNone) {
  Start();
  options_.certificate = CertificateFiles{.certificate = "/nowhere.crt", .key = "/nowhere.key"};
  const auto refused = HttpServer::Start(options_, *dispatcher_);
  ASSERT_FALSE(refused.has_value());
  EXPECT_THAT(refused.error().message(), HasSubstr("/nowhere.crt"));
}

TEST_F(HttpServerTest, SaysWhenThereIsNoPage) {
  options_.web_root = folder_ / "none";
  Start();
  EXPECT_FALSE(server_->HasPage());
  const WebAnswer answer = Ask(WebRequest("GET", "/"));
  EXPECT_EQ(answer.status, 503);
  EXPECT_THAT(answer.body, HasSubstr("VisionServer is running"));
}

}  // namespace
}  // namespace vs::test
