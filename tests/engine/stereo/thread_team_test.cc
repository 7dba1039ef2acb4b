#include "engine/stereo/thread_team.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

namespace vs {
namespace {

TEST(ThreadTeam, RunsEachPartOnceWhateverTheNumber) {
  ThreadTeam team;
  for (const int parts : {1, 4, 2, 1, 7, 3}) {
    for (int round = 0; round < 200; ++round) {
      std::vector<int> calls(static_cast<size_t>(parts), 0);  // each part writes its own
      team.Run(parts, [&](int part) { ++calls[static_cast<size_t>(part)]; });
      ASSERT_EQ(calls, std::vector<int>(static_cast<size_t>(parts), 1));
    }
  }
}

TEST(ThreadTeam, WaitsForTheHelpersWhenTheCallersPartThrows) {
  ThreadTeam team;
  std::atomic<int> done = 0;
  const auto work = [&](int part) {
    if (part == 0) throw std::runtime_error("part 0");
    ++done;
  };
  EXPECT_THROW(team.Run(4, work), std::runtime_error);
  EXPECT_EQ(done, 3);
  team.Run(2, [&](int) { ++done; });
  EXPECT_EQ(done, 5);
}

}  // namespace
}  // namespace vs
