#include "tests/support/network_namespace.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <set>
#include <string>

namespace vs::test {
namespace {

TEST(NetworkNamespace, HasNothingButALoopbackThatIsUp) {
  ifaddrs* list = nullptr;
  ASSERT_EQ(getifaddrs(&list), 0);
  std::set<std::string> up;
  std::set<std::string> all;
  for (const ifaddrs* entry = list; entry != nullptr; entry = entry->ifa_next) {
    all.insert(entry->ifa_name);
    if ((entry->ifa_flags & IFF_UP) != 0) up.insert(entry->ifa_name);
  }
  freeifaddrs(list);
  EXPECT_EQ(up, std::set<std::string>{"lo"});
  EXPECT_FALSE(all.contains("eth0"));
}

TEST(NetworkNamespace, LeavesTheGigEVisionPortFree) {
  for (const char* address : {"127.0.0.1", "127.0.0.2"}) {
    const int fd = socket(AF_INET, SOCK_DGRAM, 0);
    ASSERT_GE(fd, 0);
    sockaddr_in local{};
    local.sin_family = AF_INET;
    local.sin_port = htons(3956);
    inet_pton(AF_INET, address, &local.sin_addr);
    EXPECT_EQ(bind(fd, reinterpret_cast<const sockaddr*>(&local), sizeof local), 0) << address;
    close(fd);
  }
}

}  // namespace
}  // namespace vs::test
