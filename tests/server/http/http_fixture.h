#pragma once

#include <gtest/gtest.h>

#include <latch>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "server/http/http_server.h"
#include "server/rpc/dispatcher.h"
#include "tests/server/http/web_client.h"
#include "tests/server/rpc/dispatcher_fixture.h"
#include "tests/support/temp_folder.h"

namespace vs::test {

// Messages of a mebibyte without end, all of them the same memory.
class LargeSource final : public StreamSource {
 public:
  StreamStep Next() override { return StreamStep::Message({block_}); }

 private:
  const WireSlice block_ = ToSlice(std::string(1 << 20, 'x'));
};

// Handlers that tell what reached them.
class WebTestService {
 public:
  Result<pb::LoginResponse> Login(const Call& call, const pb::LoginRequest& request);
  Result<std::unique_ptr<StreamSource>> Watch(const Call& call, const HealthCheckRequest& request);

  std::latch waiting{1};
  std::latch go_on{1};
  Numbers numbers;
};

// An HTTP server over a dispatcher with a test's own service; limits are short where a test waits
// for them and long where it must not meet them.
class HttpTest : public ::testing::Test {
 protected:
  HttpTest();
  // The server goes before what it serves.
  ~HttpTest() override { server_.reset(); }

  // With the options as they are; plain text or TLS.
  void Start(WebClient::Tls tls = WebClient::Tls::kOff);
  WebClient Connect() const { return {server_->port(), tls_}; }

  // One request on a connection of its own, and its answer.
  WebAnswer Ask(const std::string& request) const;
  WebFrames Call(const std::string& request) const;
  static std::string LoginBytes(const std::string& user, size_t password_bytes = 0);
  static std::string WatchBytes(const std::string& service);
  // Opens a stream of numbers and waits until it is there.
  WebClient OpenStream();
  // The dispatcher has let go of every call.
  bool Idle() const;

  test::TempFolder folder_;
  FakeGate gate_;
  WebTestService service_;
  Router router_;
  DispatcherOptions dispatcher_options_;
  HttpServerOptions options_;
  WebClient::Tls tls_ = WebClient::Tls::kOff;
  std::unique_ptr<Dispatcher> dispatcher_;
  std::unique_ptr<HttpServer> server_;
};

// The same over plain text and over TLS.
class HttpBothTest : public HttpTest, public ::testing::WithParamInterface<WebClient::Tls> {
 public:
  static std::string Name(const ::testing::TestParamInfo<WebClient::Tls>& tested) {
    return tested.param == WebClient::Tls::kOn ? "Tls" : "Plain";
  }

 protected:
  void Start() { HttpTest::Start(GetParam()); }
};

}  // namespace vs::test
