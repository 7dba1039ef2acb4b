// How long the server writes to clients that read slowly or not at all.

#include "server/http/client_stream.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <functional>
#include <string>
#include <string_view>

namespace vs::test {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kSilence{50};
constexpr size_t kMessageBytes = 8 << 20;
// The kernel frees its buffer packet by packet, which on one machine are of 64 kB.
constexpr size_t kSipBytes = 40 << 10;

// Both ends of a TCP connection, with buffers much smaller than the message.
struct TcpPair {
  TcpPair() {
    const int listener = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    auto* any = reinterpret_cast<sockaddr*>(&address);
    EXPECT_EQ(::bind(listener, any, size), 0);
    EXPECT_EQ(::listen(listener, 1), 0);
    EXPECT_EQ(::getsockname(listener, any, &size), 0);
    client = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    // Packets as on a cable, so that a small buffer takes several.
    const int packet_bytes = 1460;
    const int buffer_bytes = 64 << 10;
    ::setsockopt(client, IPPROTO_TCP, TCP_MAXSEG, &packet_bytes, sizeof packet_bytes);
    ::setsockopt(client, SOL_SOCKET, SO_RCVBUF, &buffer_bytes, sizeof buffer_bytes);
    EXPECT_EQ(::connect(client, any, size), 0);
    server = ::accept4(listener, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
    // The kernel asks for more only when a third of this has been read.
    const int large_bytes = 1 << 20;
    ::setsockopt(server, SOL_SOCKET, SO_SNDBUF, &large_bytes, sizeof large_bytes);
    EXPECT_GE(server, 0);
    ::close(listener);
  }
  ~TcpPair() { ::close(client); }
  TcpPair(const TcpPair&) = delete;
  TcpPair& operator=(const TcpPair&) = delete;

  int client = -1;
  int server = -1;  // closed by its ClientStream
};

// Time passes only when the server looks at the clock, a quarter of the silence it bears; and then
// the client does something. So it is as slow on a quick machine as on one that stands still.
class ClientsClock final : public Clock {
 public:
  explicit ClientsClock(std::function<void()> client) : client_(std::move(client)) {}

  int64_t MonotonicNs() const override {
    client_();
    return now_ns_ += std::chrono::nanoseconds(kSilence).count() / 4;
  }
  int64_t UtcNs() const override { return 0; }
  milliseconds Elapsed() const {
    return std::chrono::duration_cast<milliseconds>(std::chrono::nanoseconds(now_ns_));
  }

 private:
  const std::function<void()> client_;
  mutable int64_t now_ns_ = 0;
};

class ClientStreamTest : public ::testing::Test {
 protected:
  // What the client takes each time the server looks at the clock.
  void ReadAtMost(size_t size) {
    std::string part(size, '\0');
    const ssize_t count = ::recv(sockets_.client, part.data(), size, MSG_DONTWAIT);
    if (count > 0) received_.append(part, 0, static_cast<size_t>(count));
  }
  bool Write(const Clock& clock, const Patience& patience) {
    ClientStream stream(sockets_.server, clock);
    const std::array<std::string_view, 2> pieces = {"head", message_};
    return stream.Write(pieces, patience);
  }

  TcpPair sockets_;
  const std::string message_ = std::string(kMessageBytes, 'x');
  std::string received_;
};

TEST_F(ClientStreamTest, ServesAClientThatReadsSlowly) {
  const ClientsClock clock([this] { ReadAtMost(kSipBytes); });
  ASSERT_TRUE(Write(clock, {.silence = kSilence, .least_bytes_per_s = 1}));
  EXPECT_GT(clock.Elapsed(), 10 * kSilence);
  while (received_.size() < kMessageBytes + 4) ReadAtMost(kMessageBytes);
  EXPECT_TRUE(received_ == "head" + message_);
}

TEST_F(ClientStreamTest, CutsOffAClientThatReadsNothing) {
  const ClientsClock clock([] {});
  EXPECT_FALSE(Write(clock, {.silence = kSilence, .least_bytes_per_s = 1}));
  EXPECT_LT(clock.Elapsed(), 10 * kSilence);
}

TEST_F(ClientStreamTest, CutsOffAClientThatStopsReading) {
  const ClientsClock clock([this] {
    if (received_.size() < kMessageBytes / 4) ReadAtMost(kSipBytes);
  });
  EXPECT_FALSE(Write(clock, {.silence = kSilence, .least_bytes_per_s = 1}));
}

TEST_F(ClientStreamTest, ClientThatReadsTooSlowlyHasAnEnd) {
  const ClientsClock clock([this] { ReadAtMost(kSipBytes); });
  // A second for the message.
  const Patience patience{.silence = kSilence, .least_bytes_per_s = kMessageBytes};
  EXPECT_FALSE(Write(clock, patience));
  EXPECT_GE(clock.Elapsed(), milliseconds(1000) + kSilence);
  EXPECT_LT(clock.Elapsed(), milliseconds(1000) + 10 * kSilence);
}

}  // namespace
}  // namespace vs::test
