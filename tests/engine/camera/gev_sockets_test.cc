#include "engine/camera/gev_sockets.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <optional>
#include <vector>

namespace vs {
namespace {

sockaddr_in AnyPort() {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

std::optional<UdpSocket> Find(int fd) {
  const std::vector<UdpSocket> sockets = UdpSocketsOfThisProcess();
  const auto found = std::ranges::find(sockets, fd, &UdpSocket::fd);
  return found == sockets.end() ? std::nullopt : std::optional(*found);
}

TEST(GevSockets, ASocketIsFoundWithItsAddressAndFailsAtOnceWhenItIsSilenced) {
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in own = AnyPort();
  socklen_t length = sizeof own;
  ASSERT_EQ(0, bind(fd, reinterpret_cast<const sockaddr*>(&own), sizeof own));
  ASSERT_EQ(0, getsockname(fd, reinterpret_cast<sockaddr*>(&own), &length));
  const auto found = Find(fd);
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ("127.0.0.1", found->address);
  EXPECT_EQ(ntohs(own.sin_port), found->port);

  const auto send_to_itself = [&] {
    return sendto(fd, "x", 1, 0, reinterpret_cast<const sockaddr*>(&own), sizeof own);
  };
  EXPECT_EQ(1, send_to_itself());
  Silence(*found);
  EXPECT_EQ(-1, send_to_itself());
  EXPECT_FALSE(Find(fd).has_value());
  EXPECT_EQ(0, close(fd)) << "its owner closes it as ever";
}

TEST(GevSockets, AnotherSocketWithTheSameDescriptorIsAnotherOne) {
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const auto first = Find(fd);
  const int second_fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  ASSERT_EQ(fd, dup2(second_fd, fd));
  ASSERT_TRUE(first && Find(fd));
  EXPECT_NE(*first, *Find(fd));
  close(fd);
  close(second_fd);
}

}  // namespace
}  // namespace vs
