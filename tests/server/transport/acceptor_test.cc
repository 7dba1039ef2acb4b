#include "server/transport/acceptor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <vector>

#include "engine/base/mutex.h"
#include "tests/support/raw_socket.h"
#include "tests/support/wait_until.h"

namespace vs {
namespace {

using test::RawSocket;
using test::WaitUntil;
using ::testing::HasSubstr;

// Keeps what the acceptor hands on.
class Taker {
 public:
  ~Taker() { CloseAll(); }
  void Take(int fd) {
    MutexLock lock(mutex_);
    fds_.push_back(fd);
  }
  size_t Count() {
    MutexLock lock(mutex_);
    return fds_.size();
  }
  int Option(int level, int option) {
    MutexLock lock(mutex_);
    int value = -1;
    socklen_t size = sizeof value;
    EXPECT_EQ(::getsockopt(fds_.back(), level, option, &value, &size), 0);
    return value;
  }
  void CloseOne() {
    MutexLock lock(mutex_);
    ::close(fds_.back());
    fds_.pop_back();
  }
  void CloseAll() {
    MutexLock lock(mutex_);
    for (const int fd : fds_) ::close(fd);
    fds_.clear();
  }

 private:
  Mutex mutex_;
  std::vector<int> fds_ VS_GUARDED_BY(mutex_);
};

class AcceptorTest : public ::testing::Test {
 protected:
  void Listen(int max_connections, int max_per_address) {
    acceptor_ = *Acceptor::Listen({.address = *ListenAddress::Parse("127.0.0.1:0"),
                                   .max_connections = max_connections,
                                   .max_connections_per_address = max_per_address});
  }
  void ListenWatchfully() {
    acceptor_ = *Acceptor::Listen({.address = *ListenAddress::Parse("127.0.0.1:0"),
                                   .keepalive = std::chrono::milliseconds(9'500),
                                   .vanished = std::chrono::milliseconds(45'000)});
  }
  void Start() {
    acceptor_->Start([this](int fd, const std::string& /*address*/) { taker_.Take(fd); });
  }
  bool Taken(size_t count) {
    return WaitUntil([&] { return taker_.Count() == count; });
  }

  Taker taker_;
  std::unique_ptr<Acceptor> acceptor_;
};

TEST_F(AcceptorTest, HandsConnectionsOn) {
  Listen(10, 10);
  EXPECT_NE(acceptor_->port(), 0);
  RawSocket early(acceptor_->port());
  Start();
  RawSocket late(acceptor_->port());
  EXPECT_TRUE(Taken(2));
  EXPECT_EQ(acceptor_->GetStats().open, 2);
  EXPECT_EQ(acceptor_->GetStats().accepted, 2U);
}

TEST_F(AcceptorTest, StopsAtTheLimitOfOneAddress) {
  Listen(10, 2);
  Start();
  RawSocket first(acceptor_->port());
  RawSocket second(acceptor_->port());
  EXPECT_TRUE(Taken(2));
  RawSocket third(acceptor_->port());
  EXPECT_TRUE(third.WaitForClose());
  EXPECT_EQ(acceptor_->GetStats().refused, 1U);
  // Who closes makes room.
  taker_.CloseOne();
  RawSocket fourth(acceptor_->port());
  EXPECT_TRUE(Taken(2));
  EXPECT_FALSE(fourth.Closed());
}

TEST_F(AcceptorTest, StopsAtTheLimitOfAll) {
  Listen(3, 10);
  Start();
  std::vector<RawSocket> clients;
  for (int i = 0; i < 3; ++i) clients.emplace_back(acceptor_->port());
  EXPECT_TRUE(Taken(3));
  RawSocket surplus(acceptor_->port());
  EXPECT_TRUE(surplus.WaitForClose());
  taker_.CloseAll();
  EXPECT_EQ(acceptor_->GetStats().open, 0);
  RawSocket next(acceptor_->port());
  EXPECT_TRUE(Taken(1));
}

TEST_F(AcceptorTest, IsNotDeafAfterDescriptorsRanOut) {
  Listen(1000, 1000);
  // Connected by the kernel already; nobody has accepted them yet.
  std::vector<RawSocket> clients;
  for (int i = 0; i < 40; ++i) clients.emplace_back(acceptor_->port());

  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &before), 0);
  rlimit scarce = before;
  scarce.rlim_cur = static_cast<rlim_t>(clients.back().fd()) + 11;
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &scarce), 0);
  Start();
  EXPECT_TRUE(WaitUntil([&] { return acceptor_->GetStats().refused > 0; }));
  EXPECT_TRUE(WaitUntil([&] {
    const Acceptor::Stats stats = acceptor_->GetStats();
    return stats.accepted + stats.refused >= clients.size();
  }));
  EXPECT_LE(taker_.Count(), 10U);
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &before), 0);

  taker_.CloseAll();
  RawSocket next(acceptor_->port());
  EXPECT_TRUE(Taken(1));
}

TEST_F(AcceptorTest, LeavesDescriptorsForTheRestOfTheServer) {
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &before), 0);
  rlimit scarce = before;
  scarce.rlim_cur = 66;
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &scarce), 0);
  Listen(1000, 1000);
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &before), 0);
  Start();
  RawSocket first(acceptor_->port());
  RawSocket second(acceptor_->port());
  EXPECT_TRUE(Taken(2));
  RawSocket third(acceptor_->port());
  EXPECT_TRUE(third.WaitForClose());
}

TEST_F(AcceptorTest, TakesNoMoreOnceStopped) {
  Listen(10, 10);
  Start();
  acceptor_->Stop();
  RawSocket late(acceptor_->port());  // the kernel still completes it
  EXPECT_EQ(taker_.Count(), 0U);
}

TEST_F(AcceptorTest, SaysThatItsPortIsTaken) {
  Listen(10, 10);
  const ListenAddress same = {.host = "127.0.0.1", .port = acceptor_->port()};
  const auto second = Acceptor::Listen({.address = same});
  ASSERT_FALSE(second.has_value());
  EXPECT_THAT(second.error().message(), HasSubstr("Address already in use"));
}

TEST_F(AcceptorTest, ListensOnIpv6) {
  const auto listening = Acceptor::Listen({.address = *ListenAddress::Parse("[::]:0")});
  if (!listening) GTEST_SKIP() << "this machine has no IPv6: " << listening.error().message();
  (*listening)->Start([this](int fd, const std::string& /*address*/) { taker_.Take(fd); });
  RawSocket by_ipv4((*listening)->port());
  EXPECT_TRUE(Taken(1));
}

TEST_F(AcceptorTest, NoticesAClientThatVanishesWithoutAWord) {
  ListenWatchfully();
  const RawSocket client(acceptor_->port());
  Start();
  ASSERT_TRUE(Taken(1));
  EXPECT_EQ(taker_.Option(SOL_SOCKET, SO_KEEPALIVE), 1);
  EXPECT_EQ(taker_.Option(IPPROTO_TCP, TCP_KEEPIDLE), 10);
  EXPECT_EQ(taker_.Option(IPPROTO_TCP, TCP_KEEPINTVL), 5);
  EXPECT_EQ(taker_.Option(IPPROTO_TCP, TCP_USER_TIMEOUT), 45'000);
}

TEST_F(AcceptorTest, LeavesThatToOthersWhoWantTo) {
  Listen(10, 10);
  const RawSocket client(acceptor_->port());
  Start();
  ASSERT_TRUE(Taken(1));
  EXPECT_EQ(taker_.Option(SOL_SOCKET, SO_KEEPALIVE), 0);
  EXPECT_EQ(taker_.Option(IPPROTO_TCP, TCP_USER_TIMEOUT), 0);
}

}  // namespace
}  // namespace vs
