#include "client/address.h"

#include <gtest/gtest.h>

namespace vs::client {
namespace {

std::string Parsed(std::string_view text) {
  const Result<Address> address = ParseAddress(text);
  return address ? address->ToString() : address.error().reason;
}

TEST(ServerAddress, TakesNamesAddressesAndPorts) {
  EXPECT_EQ("cell-7:50051", Parsed("cell-7"));
  EXPECT_EQ("cell-7:1", Parsed("cell-7:1"));
  EXPECT_EQ("192.168.1.5:65535", Parsed("192.168.1.5:65535"));
  EXPECT_EQ("[::1]:50051", Parsed("::1"));
  EXPECT_EQ("[fe80::1]:7000", Parsed("[fe80::1]:7000"));
  EXPECT_EQ("[fe80::1]:50051", Parsed("[fe80::1]"));
}

TEST(ServerAddress, RefusesWhatIsNone) {
  for (const char* text : {"", ":50051", "cell:", "cell:0", "cell:65536", "cell:x", "cell:50051x",
                           "[::1", "[::1]50051", "a b", "http://cell", "[]:1"}) {
    EXPECT_EQ("INVALID_ARGUMENT", Parsed(text)) << text;
  }
}

TEST(ServerAddress, KnowsThisMachine) {
  for (const char* text : {"localhost", "127.0.0.1:1", "127.9.9.9", "[::1]:5"}) {
    EXPECT_TRUE(ParseAddress(text)->IsLoopback()) << text;
  }
  for (const char* text : {"localhost.example.org", "128.0.0.1", "[fe80::1]:5", "0.0.0.0"}) {
    EXPECT_FALSE(ParseAddress(text)->IsLoopback()) << text;
  }
}

}  // namespace
}  // namespace vs::client
