#include "server/rpc/dispatcher.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <latch>
#include <stdexcept>
#include <thread>

#include "grpc/health/v1/health.pb.h"
#include "grpc/reflection/v1alpha/reflection.pb.h"
#include "visionserver/v1/session.pb.h"

#include "engine/base/mutex.h"
#include "tests/support/wait_until.h"

namespace vs {
namespace {

namespace pb = visionserver::v1;
namespace reflection = grpc::reflection::v1alpha;
using grpc::health::v1::HealthCheckRequest;
using grpc::health::v1::HealthCheckResponse;
using test::WaitUntil;
using ::testing::HasSubstr;

constexpr const char* kLogin = "/visionserver.v1.SessionService/Login";
constexpr const char* kWhoAmI = "/visionserver.v1.SessionService/WhoAmI";
constexpr const char* kLogout = "/visionserver.v1.SessionService/Logout";
constexpr const char* kWatch = "/grpc.health.v1.Health/Watch";
constexpr const char* kCheck = "/grpc.health.v1.Health/Check";
constexpr const char* kExchange = "/grpc.reflection.v1alpha.ServerReflection/ServerReflectionInfo";

// The credential "good" is valid until the test says otherwise.
class FakeGate final : public Gatekeeper {
 public:
  Result<Caller> Admit(const std::string& /*method*/, std::string_view credential) override {
    if (!credential.starts_with("good")) return Unauthenticated("not let in");
    return Caller{
        .kind = Caller::Kind::kUser, .name = "maria", .credential_id = std::string(credential)};
  }
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

class DispatcherTest : public ::testing::Test {
 protected:
  void SetUp() override {
    MethodOptions small = {.max_request_bytes = 100};
    router_.Unary(kLogin, &service_, &TestService::Login, small);
    router_.Unary(kWhoAmI, &service_, &TestService::WhoAmI, {.lane = Lane::kInline});
    MethodOptions refusing;
    refusing.admit = [](const Call& /*call*/) { return ResourceExhausted("too often"); };
    router_.Unary(kLogout, &service_, &TestService::Logout, refusing);
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

TEST_F(DispatcherTest, AnswersAUnaryCall) {
  FakeChannel channel;
  const auto call = Begin(kLogin, channel);
  EXPECT_EQ(channel.receives, 1);
  call->OnRequest(LoginBytes("maria"));
  EXPECT_TRUE(channel.status().ok());
  pb::LoginResponse response;
  ASSERT_EQ(channel.messages().size(), 1U);
  ASSERT_TRUE(response.ParseFromString(channel.messages()[0]));
  EXPECT_EQ(response.token(), "maria");
}

TEST_F(DispatcherTest, LooksAtNoRequestOfAStranger) {
  FakeChannel channel;
  Begin(kLogin, channel, "bad");
  EXPECT_EQ(channel.status().code(), StatusCode::kUnauthenticated);
  EXPECT_EQ(channel.receives, 0);
}

TEST_F(DispatcherTest, KnowsWhatItDoesNotHave) {
  FakeChannel channel;
  Begin("/visionserver.v1.SessionService/Nothing", channel);
  EXPECT_EQ(channel.status().code(), StatusCode::kUnimplemented);
}

TEST_F(DispatcherTest, RefusesBadRequestsBeforeTheHandler) {
  FakeChannel empty;
  Begin(kLogin, empty)->OnRequest(std::nullopt);
  EXPECT_EQ(empty.status().code(), StatusCode::kInvalidArgument);
  FakeChannel garbage;
  Begin(kLogin, garbage)->OnRequest("\x0a\x7f");
  EXPECT_EQ(garbage.status().code(), StatusCode::kInvalidArgument);
  FakeChannel large;
  Begin(kLogin, large)->OnRequest(std::string(101, ' '));
  EXPECT_EQ(large.status().code(), StatusCode::kResourceExhausted);
  FakeChannel turned_away;
  Begin(kLogout, turned_away)->OnRequest("");
  EXPECT_EQ(turned_away.status(), ResourceExhausted("too often"));
}

TEST_F(DispatcherTest, ExceptionEndsTheCallOnlyAndTellsNoSecrets) {
  FakeChannel channel;
  Begin(kLogin, channel)->OnRequest(LoginBytes("throw"));
  EXPECT_EQ(channel.status().code(), StatusCode::kInternal);
  EXPECT_THAT(channel.status().message(), HasSubstr("incident"));
  EXPECT_THAT(channel.status().message(), ::testing::Not(HasSubstr("secret")));
  FakeChannel memory;
  Begin(kLogin, memory)->OnRequest(LoginBytes("no memory"));
  EXPECT_EQ(memory.status().code(), StatusCode::kResourceExhausted);
}

TEST_F(DispatcherTest, FullLaneTurnsCallsAway) {
  Start({.quick_threads = 1, .quick_queue = 1});
  FakeChannel working;
  Begin(kLogin, working)->OnRequest(LoginBytes("wait"));
  service_.waiting.wait();
  FakeChannel queued;
  Begin(kLogin, queued)->OnRequest(LoginBytes("maria"));
  FakeChannel surplus;
  Begin(kLogin, surplus)->OnRequest(LoginBytes("maria"));
  EXPECT_EQ(surplus.status().reason(), "OVERLOADED");
  // What does not need the lane is not held up.
  FakeChannel other;
  Begin(kWhoAmI, other)->OnRequest("");
  EXPECT_TRUE(other.status().ok());
  service_.go_on.count_down();
  EXPECT_TRUE(working.status().ok());
  EXPECT_TRUE(queued.status().ok());
}

TEST_F(DispatcherTest, HandlerLearnsThatTheClientHasGone) {
  FakeChannel channel;
  const auto call = Begin(kLogin, channel);
  call->OnRequest(LoginBytes("wait"));
  service_.waiting.wait();
  call->OnCancelled();
  service_.go_on.count_down();
  EXPECT_TRUE(channel.Ended());
  EXPECT_TRUE(service_.was_cancelled);
}

TEST_F(DispatcherTest, DoesNotBeginWorkThatNobodyWaitsFor) {
  Start({.quick_threads = 1});
  FakeChannel working;
  Begin(kLogin, working)->OnRequest(LoginBytes("wait"));
  service_.waiting.wait();
  FakeChannel channel;
  const auto call = Begin(kLogin, channel);
  call->OnRequest(LoginBytes("maria"));
  call->OnCancelled();
  service_.go_on.count_down();
  EXPECT_EQ(channel.status().code(), StatusCode::kCancelled);
}

TEST_F(DispatcherTest, StreamSendsTheNewestOnceTheLastIsOut) {
  FakeChannel channel;
  const auto call = Open(channel);
  service_.numbers.Publish(1);
  ASSERT_TRUE(WaitUntil([&] { return channel.messages().size() == 1; }));
  // The client is slow: what comes meanwhile replaces each other.
  for (int i = 2; i <= 50; ++i) service_.numbers.Publish(i);
  EXPECT_EQ(channel.messages().size(), 1U);
  call->OnSent(true);
  ASSERT_TRUE(WaitUntil([&] { return channel.messages().size() == 2; }));
  EXPECT_EQ(channel.messages()[1], "50");
  call->OnSent(true);
  service_.numbers.Publish(-1);
  EXPECT_EQ(channel.status(), DataLoss("no more"));
  EXPECT_EQ(dispatcher_->OpenStreams(), 0U);
}

TEST_F(DispatcherTest, StreamThatCannotOpenSaysWhy) {
  FakeChannel channel;
  Begin(kWatch, channel)->OnRequest(WatchBytes("nothing"));
  EXPECT_EQ(channel.status(), NotFound("nothing there"));
}

TEST_F(DispatcherTest, ExceptionOfASourceEndsItsStream) {
  FakeChannel channel;
  const auto call = Open(channel);
  service_.numbers.Publish(-2);
  EXPECT_EQ(channel.status().code(), StatusCode::kInternal);
  EXPECT_TRUE(WaitUntil([&] { return service_.numbers.sources == 0; }));
}

TEST_F(DispatcherTest, SourceIsAskedAgainAtTheInstantItNamed) {
  FakeChannel channel;
  const auto call = Open(channel, "clock");
  for (size_t i = 1; i <= 5; ++i) {
    ASSERT_TRUE(WaitUntil([&] { return channel.messages().size() == i; }));
    call->OnSent(true);
  }
  EXPECT_TRUE(channel.status().ok());
  EXPECT_EQ(channel.messages().size(), 5U);
}

TEST_F(DispatcherTest, ClientThatLeavesFreesItsSource) {
  FakeChannel resting;
  const auto idle = Open(resting);
  idle->OnCancelled();
  EXPECT_EQ(resting.status().code(), StatusCode::kCancelled);
  EXPECT_TRUE(WaitUntil([&] { return service_.numbers.sources == 0; }));

  FakeChannel sending;
  const auto busy = Open(sending);
  service_.numbers.Publish(1);
  ASSERT_TRUE(WaitUntil([&] { return sending.messages().size() == 1; }));
  busy->OnCancelled();
  busy->OnSent(false);
  EXPECT_EQ(sending.status().code(), StatusCode::kCancelled);
  EXPECT_TRUE(WaitUntil([&] { return service_.numbers.sources == 0; }));
}

TEST_F(DispatcherTest, WakeAfterTheEndDoesNothing) {
  FakeChannel channel;
  {
    const auto call = Open(channel);
    call->OnCancelled();
    EXPECT_TRUE(channel.Ended());
  }
  service_.numbers.Publish(7);
  EXPECT_TRUE(channel.messages().empty());
}

TEST_F(DispatcherTest, UnaryCallMayWaitForASource) {
  FakeChannel channel;
  const auto call = Begin(kCheck, channel);
  call->OnRequest("");
  ASSERT_TRUE(WaitUntil([&] { return service_.numbers.sources == 1; }));
  service_.numbers.Publish(7);
  EXPECT_TRUE(channel.status().ok());
  EXPECT_EQ(channel.messages(), std::vector<std::string>{"7"});
}

TEST_F(DispatcherTest, ClientStreamIsAnsweredRequestByRequest) {
  FakeChannel channel;
  const auto call = Begin(kExchange, channel);
  for (int i = 1; i <= 3; ++i) {
    ASSERT_EQ(channel.receives, i);
    reflection::ServerReflectionRequest request;
    request.set_host(std::to_string(i));
    call->OnRequest(request.SerializeAsString());
    ASSERT_TRUE(WaitUntil([&] { return channel.messages().size() == static_cast<size_t>(i); }));
    call->OnSent(true);
  }
  call->OnRequest(std::nullopt);
  EXPECT_TRUE(channel.status().ok());
}

TEST_F(DispatcherTest, RevokedSessionEndsItsStreams) {
  FakeChannel idle;
  const auto first = Open(idle);
  gate_.valid = false;
  EXPECT_EQ(idle.status(), Unauthenticated("session has ended"));
}

TEST_F(DispatcherTest, RevokedSessionEndsAStreamThatNobodyReads) {
  FakeChannel channel;
  const auto call = Open(channel);
  service_.numbers.Publish(1);
  ASSERT_TRUE(WaitUntil([&] { return channel.messages().size() == 1; }));
  gate_.valid = false;
  ASSERT_TRUE(WaitUntil([&] { return channel.aborts > 0; }));
  call->OnSent(false);
  EXPECT_EQ(channel.status(), Unauthenticated("session has ended"));
}

TEST_F(DispatcherTest, StreamThatNobodyReadsIsCutOff) {
  Start({.unread_limit_ns = 5'000'000});
  FakeChannel channel;
  const auto call = Open(channel);
  service_.numbers.Publish(1);
  ASSERT_TRUE(WaitUntil([&] { return channel.aborts > 0; }));
  call->OnSent(false);
  EXPECT_EQ(channel.status().code(), StatusCode::kCancelled);
  EXPECT_TRUE(WaitUntil([&] { return service_.numbers.sources == 0; }));
}

TEST_F(DispatcherTest, AnswerThatNobodyReadsIsCutOff) {
  Start({.unread_limit_ns = 5'000'000});
  FakeChannel channel;
  const auto call = Begin(kLogin, channel);
  call->OnRequest(LoginBytes("maria"));
  EXPECT_TRUE(channel.status().ok());
  EXPECT_TRUE(WaitUntil([&] { return channel.aborts == 1; }));
  call->OnDone();
}

TEST_F(DispatcherTest, ReadingAStreamCountsAsUseOfTheSession) {
  FakeChannel channel;
  const auto call = Open(channel);
  EXPECT_EQ(gate_.uses, 0);
  service_.numbers.Publish(1);
  ASSERT_TRUE(WaitUntil([&] { return channel.messages().size() == 1; }));
  call->OnSent(true);
  EXPECT_TRUE(WaitUntil([&] { return gate_.uses == 1; }));
  call->OnCancelled();
}

TEST_F(DispatcherTest, RefusesMoreStreamsThanItTakes) {
  Start({.max_open_streams = 2});
  FakeChannel first;
  FakeChannel second;
  FakeChannel third;
  const auto one = Open(first);
  const auto two = Open(second);
  Begin(kWatch, third)->OnRequest("");
  EXPECT_EQ(third.status().code(), StatusCode::kResourceExhausted);
  one->OnCancelled();
  EXPECT_TRUE(first.Ended());
  FakeChannel fourth;
  const auto four = Open(fourth);
  two->OnCancelled();
  four->OnCancelled();
  EXPECT_TRUE(second.Ended());
  EXPECT_TRUE(fourth.Ended());
}

TEST_F(DispatcherTest, OneSessionDoesNotTakeTheStreamsOfAll) {
  Start({.max_open_streams = 3, .max_streams_per_session = 1});
  FakeChannel first;
  FakeChannel second;
  FakeChannel other;
  const auto one = Open(first);
  Begin(kWatch, second)->OnRequest("");
  EXPECT_EQ(second.status().code(), StatusCode::kResourceExhausted);
  EXPECT_THAT(second.status().message(), HasSubstr("this login"));
  const auto bens = Begin(kWatch, other, "good ben");
  bens->OnRequest("");
  EXPECT_TRUE(WaitUntil([&] { return dispatcher_->OpenStreams() == 2; }));
  one->OnCancelled();
  bens->OnCancelled();
  EXPECT_TRUE(first.Ended());
  EXPECT_TRUE(other.Ended());
}

TEST_F(DispatcherTest, DrainEndsStreamsAndRefusesCalls) {
  FakeChannel stream;
  const auto open = Open(stream);
  FakeChannel working;
  Begin(kLogin, working)->OnRequest(LoginBytes("wait"));
  service_.waiting.wait();
  dispatcher_->Drain();
  EXPECT_EQ(stream.status().code(), StatusCode::kUnavailable);
  FakeChannel late;
  Begin(kLogin, late);
  EXPECT_EQ(late.status().code(), StatusCode::kUnavailable);
  // What runs comes to its end.
  EXPECT_FALSE(dispatcher_->Idle());
  service_.go_on.count_down();
  EXPECT_TRUE(working.status().ok());
}

TEST_F(DispatcherTest, DrainStopsWhatWorksAndWhatQueues) {
  Start({.quick_threads = 1});
  FakeChannel working;
  Begin(kLogin, working)->OnRequest(LoginBytes("until cancelled"));
  service_.waiting.wait();
  FakeChannel queued;
  Begin(kLogin, queued)->OnRequest(LoginBytes("maria"));
  dispatcher_->Drain();
  // Neither failed by itself.
  EXPECT_EQ(working.status(), Unavailable("the server is shutting down"));
  EXPECT_EQ(queued.status(), Unavailable("the server is shutting down"));
  EXPECT_TRUE(WaitUntil([&] { return dispatcher_->Idle(); }));
}

TEST_F(DispatcherTest, CountsCallsByMethod) {
  FakeChannel good;
  Begin(kLogin, good)->OnRequest(LoginBytes("maria"));
  EXPECT_TRUE(good.Ended());
  FakeChannel denied;
  Begin(kLogin, denied, "bad");
  FakeChannel left;
  Open(left)->OnCancelled();
  EXPECT_TRUE(left.Ended());
  const std::vector<MethodStats> stats = dispatcher_->Statistics();
  ASSERT_EQ(stats.size(), 2U);
  EXPECT_EQ(stats[0].method, kWatch);
  EXPECT_EQ(stats[0].succeeded, 1U);
  EXPECT_EQ(stats[1].method, kLogin);
  EXPECT_EQ(stats[1].succeeded, 1U);
  EXPECT_EQ(stats[1].failed, 1U);
  EXPECT_GT(stats[1].mean_us, 0);
}

}  // namespace
}  // namespace vs
