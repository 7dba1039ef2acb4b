#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <latch>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "grpc/health/v1/health.pb.h"
#include "grpc/reflection/v1alpha/reflection.pb.h"
#include "visionserver/v1/result.pb.h"
#include "visionserver/v1/session.pb.h"

#include "engine/base/mutex.h"
#include "server/rpc/dispatcher.h"
#include "tests/support/wait_until.h"

namespace vs::test {

namespace pb = visionserver::v1;
namespace reflection = grpc::reflection::v1alpha;
using grpc::health::v1::HealthCheckRequest;
using grpc::health::v1::HealthCheckResponse;

inline constexpr const char* kLogin = "/visionserver.v1.SessionService/Login";
inline constexpr const char* kWhoAmI = "/visionserver.v1.SessionService/WhoAmI";
inline constexpr const char* kLogout = "/visionserver.v1.SessionService/Logout";
inline constexpr const char* kQuery = "/visionserver.v1.ResultService/QueryResults";
inline constexpr const char* kWatch = "/grpc.health.v1.Health/Watch";
inline constexpr const char* kCheck = "/grpc.health.v1.Health/Check";
inline constexpr const char* kExchange =
    "/grpc.reflection.v1alpha.ServerReflection/ServerReflectionInfo";

// The credential "good" is valid until the test says otherwise.
class FakeGate final : public Gatekeeper {
 public:
  Result<Caller> Admit(const std::string& /*method*/, std::string_view credential) override {
    if (!credential.starts_with("good")) return Unauthenticated("not let in");
    return Caller{
        .kind = Caller::Kind::kUser, .name = "maria", .credential_id = std::string(credential)};
  }
  Caller Identify(std::string_view /*credential*/) override { return Caller(); }
  Status Recheck(const std::string& /*method*/, const Caller& /*caller*/, bool in_use) override {
    if (in_use) ++uses;
    return valid ? Status() : Unauthenticated("session has ended");
  }

  std::atomic<bool> valid{true};
  std::atomic<int> uses{0};
};

// A client that answers as a test wants.
class FakeChannel final : public Channel {
 public:
  FakeChannel() = default;
  // A call uses its channel until it has ended.
  ~FakeChannel() override { EXPECT_TRUE(Ended()); }
  FakeChannel(const FakeChannel&) = delete;
  FakeChannel& operator=(const FakeChannel&) = delete;

  void Receive() override { ++receives; }
  void Send(WireMessage message) override { Add(message); }
  void SendAndFinish(WireMessage message) override {
    Add(message);
    Finish(Status());
  }
  void Finish(const Status& status) override {
    EXPECT_FALSE(finished) << "finished twice";
    {
      MutexLock lock(mutex_);
      status_ = status;
    }
    finished = true;
  }
  void Abort() override { ++aborts; }

  std::vector<std::string> messages() {
    MutexLock lock(mutex_);
    return messages_;
  }
  bool Ended() {
    return WaitUntil([&] { return finished.load(); });
  }
  Status status() {
    EXPECT_TRUE(Ended());
    MutexLock lock(mutex_);
    return status_;
  }

  std::atomic<int> receives{0};
  std::atomic<int> aborts{0};
  std::atomic<bool> finished{false};

 private:
  void Add(const WireMessage& message) {
    std::string bytes;
    for (const WireSlice& slice : message) {
      bytes.append(static_cast<const char*>(slice.data), slice.size_bytes);
    }
    MutexLock lock(mutex_);
    messages_.push_back(std::move(bytes));
  }

  Mutex mutex_;
  std::vector<std::string> messages_ VS_GUARDED_BY(mutex_);
  Status status_ VS_GUARDED_BY(mutex_);
};

// What the streams of a test say: the newest number, once each; -1 ends, -2 throws.
class Numbers {
 public:
  void Publish(int number) {
    std::function<void()> wake;
    {
      MutexLock lock(mutex_);
      newest_ = number;
      wake = wake_;
    }
    if (wake) wake();
  }
  void Listen(std::function<void()> wake) {
    MutexLock lock(mutex_);
    wake_ = std::move(wake);
  }
  int Take() {
    MutexLock lock(mutex_);
    return std::exchange(newest_, 0);
  }

  std::atomic<int> sources{0};

 private:
  Mutex mutex_;
  std::function<void()> wake_ VS_GUARDED_BY(mutex_);
  int newest_ VS_GUARDED_BY(mutex_) = 0;
};

class NumberSource final : public StreamSource {
 public:
  explicit NumberSource(Numbers& numbers) : numbers_(numbers) { ++numbers_.sources; }
  ~NumberSource() override { --numbers_.sources; }
  NumberSource(const NumberSource&) = delete;
  NumberSource& operator=(const NumberSource&) = delete;

  void Start(std::function<void()> wake) override { numbers_.Listen(std::move(wake)); }
  StreamStep Next() override {
    const int number = numbers_.Take();
    if (number == 0) return StreamStep::Wait();
    if (number == -1) return StreamStep::End(DataLoss("no more"));
    if (number == -2) throw std::runtime_error("a bug in a source");
    return StreamStep::Message({ToSlice(std::to_string(number))});
  }

 private:
  Numbers& numbers_;
};

// Counts to five, a number every millisecond, without anybody waking it.
class TickingSource final : public StreamSource {
 public:
  StreamStep Next() override {
    const int64_t now_ns = SystemClock().MonotonicNs();
    if (now_ns < due_ns_) return StreamStep::Wait(due_ns_);
    if (count_ == 5) return StreamStep::End();
    due_ns_ = now_ns + 1'000'000;
    return StreamStep::Message({ToSlice(std::to_string(++count_))});
  }

 private:
  int count_ = 0;
  int64_t due_ns_ = 0;
};

// Handlers that do what their requests say.
class TestService {
 public:
  Result<pb::LoginResponse> Login(const Call& call, const pb::LoginRequest& request) {
    if (request.user() == "throw") throw std::runtime_error("a secret of the inside");
    if (request.user() == "no memory") throw std::bad_alloc();
    if (request.user() == "wait") {
      waiting.count_down();
      go_on.wait();
    }
    was_cancelled = call.cancelled.stop_requested();
    if (request.user() == "until cancelled") {
      waiting.count_down();
      EXPECT_TRUE(WaitUntil([&] { return call.cancelled.stop_requested(); }));
      return Cancelled("nobody waits");
    }
    pb::LoginResponse response;
    response.set_token(call.caller.name);
    return response;
  }
  Result<pb::WhoAmIResponse> WhoAmI(const Call& /*call*/, const pb::WhoAmIRequest& /*request*/) {
    return pb::WhoAmIResponse();
  }
  Result<pb::LogoutResponse> Logout(const Call& /*call*/, const pb::LogoutRequest& /*request*/) {
    return pb::LogoutResponse();
  }
  Result<pb::QueryResultsResponse> Query(const Call& /*call*/,
                                         const pb::QueryResultsRequest& request) {
    if (request.sql() == "wait") {
      waiting.count_down();
      go_on.wait();
    }
    return pb::QueryResultsResponse();
  }
  Result<std::unique_ptr<StreamSource>> Watch(const Call& /*call*/,
                                              const HealthCheckRequest& request) {
    if (request.service() == "nothing") return NotFound("nothing there");
    if (request.service() == "clock") return std::make_unique<TickingSource>();
    return std::make_unique<NumberSource>(numbers);
  }
  Result<reflection::ServerReflectionResponse> Exchange(
      const Call& /*call*/, const reflection::ServerReflectionRequest& request) {
    if (request.host() == "stop") return InvalidArgument("stopped");
    reflection::ServerReflectionResponse response;
    response.set_valid_host(request.host());
    return response;
  }

  std::latch waiting{1};
  std::latch go_on{1};
  std::atomic<bool> was_cancelled{false};
  Numbers numbers;
};

// A dispatcher over a test's own service, and how calls come to it.
class DispatcherTest : public ::testing::Test {
 protected:
  void SetUp() override {
    MethodOptions small = {.max_request_bytes = 100};
    router_.Unary(kLogin, &service_, &TestService::Login, small);
    router_.Unary(kWhoAmI, &service_, &TestService::WhoAmI, {.lane = Lane::kInline});
    MethodOptions refusing;
    refusing.admit = [](const Call& /*call*/) { return ResourceExhausted("too often"); };
    router_.Unary(kLogout, &service_, &TestService::Logout, refusing);
    router_.Unary(kQuery, &service_, &TestService::Query, {.lane = Lane::kQuery});
    router_.Stream(kWatch, &service_, &TestService::Watch);
    // A unary method whose answer comes from a source.
    router_.Stream(kCheck, &service_, &TestService::Watch);
    router_.Unary(kExchange, &service_, &TestService::Exchange);
    Start({});
  }
  void Start(DispatcherOptions options) {
    dispatcher_.reset();
    options.inspection_period_ns = 1'000'000;
    dispatcher_ = std::make_unique<Dispatcher>(router_, gate_, options);
  }
  std::shared_ptr<ServerCall> Begin(const std::string& method, FakeChannel& channel,
                                    const std::string& credential = "good") {
    return dispatcher_->Begin(method, credential, "10.0.0.1", channel);
  }
  static std::string LoginBytes(const std::string& user) {
    pb::LoginRequest request;
    request.set_user(user);
    return request.SerializeAsString();
  }
  static std::string QueryBytes(const std::string& sql) {
    pb::QueryResultsRequest request;
    request.set_sql(sql);
    return request.SerializeAsString();
  }
  static std::string WatchBytes(const std::string& name) {
    HealthCheckRequest request;
    request.set_service(name);
    return request.SerializeAsString();
  }
  // Opens a stream and waits until it is there.
  std::shared_ptr<ServerCall> Open(FakeChannel& channel, const std::string& name = "") {
    const size_t before = dispatcher_->OpenStreams();
    auto call = Begin(kWatch, channel);
    call->OnRequest(WatchBytes(name));
    EXPECT_TRUE(WaitUntil([&] { return dispatcher_->OpenStreams() > before; }));
    return call;
  }

  FakeGate gate_;
  TestService service_;
  Router router_;
  std::unique_ptr<Dispatcher> dispatcher_;
};

}  // namespace vs::test
