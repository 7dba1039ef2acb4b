#include "tests/server/http/http_fixture.h"

#include <filesystem>
#include <fstream>

#include "engine/base/str.h"
#include "tests/support/wait_until.h"

namespace vs::test {

Result<pb::LoginResponse> WebTestService::Login(const vs::Call& call,
                                                const pb::LoginRequest& request) {
  if (request.user() == "fail") {
    Status fault(StatusCode::kNotFound, "Ger\xc3\xa4t fehlt zu 100 %", {{"left", "is unplugged"}});
    return fault.WithReason("CAMERA_GONE");
  }
  if (request.user() == "wait") {
    waiting.count_down();
    go_on.wait();
  }
  pb::LoginResponse response;
  response.set_token(
      Str(call.caller.name, " at ", call.address, " sent ", request.password().size()));
  return response;
}

Result<std::unique_ptr<StreamSource>> WebTestService::Watch(const vs::Call& /*call*/,
                                                            const HealthCheckRequest& request) {
  if (request.service() == "large") return std::make_unique<LargeSource>();
  return std::make_unique<NumberSource>(numbers);
}

HttpTest::HttpTest() {
  using std::chrono::hours;
  router_.Unary(kLogin, &service_, &WebTestService::Login);
  router_.Stream(kWatch, &service_, &WebTestService::Watch);
  std::filesystem::create_directories(folder_ / "web/assets");
  std::ofstream(folder_ / "web/index.html") << "<p>hello";
  dispatcher_options_.inspection_period_ns = 1'000'000;
  dispatcher_options_.unread.silence = hours(1);
  options_.acceptor.address = {.host = "127.0.0.1", .port = 0};
  options_.web_root = folder_ / "web";
  options_.limits = {
      .handshake = hours(1), .head = hours(1), .idle = hours(1), .file = {.silence = hours(1)}};
  options_.limits.calls.request_time = hours(1);
  options_.limits.calls.unread.silence = hours(1);
}

void HttpTest::Start(WebClient::Tls tls) {
  server_.reset();  // of an earlier start
  tls_ = tls;
  if (tls == WebClient::Tls::kOn) options_.certificate = *EnsureCertificate(folder_ / "tls");
  dispatcher_ = std::make_unique<Dispatcher>(router_, gate_, dispatcher_options_);
  auto started = HttpServer::Start(options_, *dispatcher_);
  ASSERT_TRUE(started.has_value()) << started.error().ToString();
  server_ = std::move(*started);
  server_->TakeConnections();
}

WebAnswer HttpTest::Ask(const std::string& request) const {
  WebClient client = Connect();
  client.Send(request);
  std::optional<WebAnswer> answer = client.Receive(!request.starts_with("HEAD"));
  EXPECT_TRUE(answer.has_value()) << "no answer to " << request.substr(0, 60);
  return answer.value_or(WebAnswer());
}

WebFrames HttpTest::Call(const std::string& request) const { return FramesOf(Ask(request).body); }

std::string HttpTest::LoginBytes(const std::string& user, size_t password_bytes) {
  pb::LoginRequest request;
  request.set_user(user);
  request.set_password(std::string(password_bytes, 'p'));
  return request.SerializeAsString();
}

std::string HttpTest::WatchBytes(const std::string& service) {
  HealthCheckRequest request;
  request.set_service(service);
  return request.SerializeAsString();
}

WebClient HttpTest::OpenStream() {
  const size_t before = dispatcher_->OpenStreams();
  WebClient client = Connect();
  client.Send(WebPost(kWatch, ""));
  EXPECT_TRUE(WaitUntil([&] { return dispatcher_->OpenStreams() > before; }));
  return client;
}

bool HttpTest::Idle() const {
  return WaitUntil([&] { return dispatcher_->Idle(); });
}

}  // namespace vs::test
