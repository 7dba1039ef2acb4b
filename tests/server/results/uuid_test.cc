#include "server/results/uuid.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace vs {
namespace {

TEST(Uuid, Version7BeginsWithTheTime) {
  // RFC 9562, appendix A.6: 2022-02-22 19:22:22 UTC is 017F22E2-79B0-7...
  UuidV7Generator ids;
  const std::string id = ids.Next(1'645'557'742'000'000'000);
  ASSERT_EQ(36u, id.size());
  EXPECT_EQ("017f22e2-79b0-7000-", id.substr(0, 19));
  EXPECT_NE(std::string::npos, std::string("89ab").find(id[19]));
}

TEST(Uuid, Version7SortsByCreationEvenWhenTheClockStandsOrGoesBack) {
  UuidV7Generator ids;
  std::string last = ids.Next(1'645'557'742'000'000'000);
  for (int i = 0; i < 10'000; ++i) {
    const std::string next = ids.Next(1'645'557'742'000'000'000 - i);
    ASSERT_LT(last, next);
    last = next;
  }
}

TEST(Uuid, Version4IsRandom) {
  std::set<std::string> seen;
  for (int i = 0; i < 1000; ++i) {
    const std::string id = RandomUuid();
    EXPECT_EQ('4', id[14]);
    EXPECT_TRUE(seen.insert(id).second);
  }
}

}  // namespace
}  // namespace vs
