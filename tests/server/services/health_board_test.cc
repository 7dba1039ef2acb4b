#include "server/services/health_board.h"

#include <gtest/gtest.h>

namespace vs {
namespace {

TEST(HealthBoard, TellsChangesOnly) {
  HealthBoard board;
  int told = 0;
  const auto listening = board.Listen([&] { ++told; });
  board.Set("sequences/a", true);
  EXPECT_EQ(told, 1);
  board.Set("sequences/a", true);
  board.Remove("sequences/b");
  EXPECT_EQ(told, 1);
  board.Set("sequences/a", false);
  EXPECT_EQ(told, 2);
  board.Remove("sequences/a");
  EXPECT_EQ(told, 3);
}

}  // namespace
}  // namespace vs
