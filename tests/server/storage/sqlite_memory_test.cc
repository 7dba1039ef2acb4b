#include "server/storage/sqlite_memory.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <thread>

#include "server/storage/sqlite.h"
#include "tests/support/temp_folder.h"

namespace vs {
namespace {

TEST(SqliteMemory, IsChargedToTheThreadThatTookIt) {
  const test::TempFolder folder;
  auto database = Database::Open(folder / "store.db", Database::Access::kCreate).value();
  auto query = database.Prepare("SELECT zeroblob(1000000) || ''").value();
  int64_t others = 0;
  int64_t taken = 0;
  const int64_t before = SqliteBytesOfThread();
  std::thread([&] {
    const int64_t at_first = SqliteBytesOfThread();
    ASSERT_TRUE(query.Step().value());
    taken = SqliteBytesOfThread() - at_first;
    others = -at_first;
  }).join();
  EXPECT_GE(taken, 1'000'000);
  EXPECT_EQ(others, 0);
  EXPECT_EQ(SqliteBytesOfThread(), before);
  // Given back by this thread.
  query.Reset();
  EXPECT_LE(SqliteBytesOfThread(), before - 1'000'000);
}

}  // namespace
}  // namespace vs
