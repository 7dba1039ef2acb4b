#include "server/transport/listen_address.h"

#include <gtest/gtest.h>

namespace vs {
namespace {

TEST(ListenAddress, ReadsWhatPeopleWrite) {
  EXPECT_EQ(ListenAddress::Parse("0.0.0.0:50051")->host, "0.0.0.0");
  EXPECT_EQ(ListenAddress::Parse("0.0.0.0:50051")->port, 50051);
  EXPECT_EQ(ListenAddress::Parse("[::1]:0")->host, "::1");
  EXPECT_EQ(ListenAddress::Parse("localhost:65535")->host, "127.0.0.1");
  EXPECT_EQ(ListenAddress::Parse("[::1]:7")->ToString(), "[::1]:7");
  EXPECT_EQ(ListenAddress::Parse("10.0.0.1:7")->ToString(), "10.0.0.1:7");
}

TEST(ListenAddress, RefusesTheRest) {
  for (const char* text :
       {"", ":50051", "0.0.0.0", "0.0.0.0:", "0.0.0.0:65536", "0.0.0.0:-1", "::1:50051", "[::1:5",
        "1.2.3:5", "example.org:5", "0.0.0.0:5x", "[0.0.0.0]:5"}) {
    const Result<ListenAddress> address = ListenAddress::Parse(text);
    ASSERT_FALSE(address.has_value()) << text;
    EXPECT_EQ(address.error().code(), StatusCode::kInvalidArgument);
  }
}

TEST(ListenAddress, KnowsThisMachine) {
  EXPECT_TRUE(ListenAddress::Parse("127.0.0.1:1")->IsLoopback());
  EXPECT_TRUE(ListenAddress::Parse("127.3.2.1:1")->IsLoopback());
  EXPECT_TRUE(ListenAddress::Parse("[::1]:1")->IsLoopback());
  EXPECT_FALSE(ListenAddress::Parse("0.0.0.0:1")->IsLoopback());
  EXPECT_FALSE(ListenAddress::Parse("[::]:1")->IsLoopback());
  EXPECT_FALSE(ListenAddress::Parse("192.168.127.1:1")->IsLoopback());
}

}  // namespace
}  // namespace vs
