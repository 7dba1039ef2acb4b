#include "engine/core/graph.h"

#include <gtest/gtest.h>

namespace vs {
namespace {

using Cycles = std::vector<std::vector<int>>;

TEST(TopologicalOrder, TakesTheSmallestNodeThatIsFree) {
  //   2 -> 0 -> 3,  1 -> 3
  EXPECT_EQ(TopologicalOrder({{3}, {3}, {0}, {}}), (std::vector<int>{1, 2, 0, 3}));
  EXPECT_EQ(TopologicalOrder({}), std::vector<int>{});
}

TEST(TopologicalOrder, LeavesOutWhatACycleFeeds) {
  //   0 -> 1 <-> 2 -> 3
  EXPECT_EQ(TopologicalOrder({{1}, {2}, {1, 3}, {}}), std::vector<int>{0});
}

TEST(FindCycles, NamesOnlyTheNodesOnTheCycleAlongItsEdges) {
  //   0 -> 2 -> 1 -> 3 -> 2,  3 -> 4
  EXPECT_EQ(FindCycles({{2}, {3}, {1}, {2, 4}, {}}), (Cycles{{1, 3, 2}}));
}

TEST(FindCycles, SeesANodeThatFeedsItselfAndDoubleEdges) {
  EXPECT_EQ(FindCycles({{0}}), (Cycles{{0}}));
  EXPECT_EQ(FindCycles({{1, 1}, {}}), Cycles{});
  EXPECT_EQ(FindCycles({{1, 1}, {0}}), (Cycles{{0, 1}}));
}

TEST(FindCycles, FindsEachOfSeveral) {
  //   0 <-> 1 -> 2 <-> 3, 4 -> 4
  EXPECT_EQ(FindCycles({{1}, {0, 2}, {3}, {2}, {4}}), (Cycles{{0, 1}, {2, 3}, {4}}));
}

// A recursive or quadratic search would not come back from these.
TEST(FindCycles, TakesHugeGraphs) {
  constexpr int kNodes = 200'000;
  Graph ring(kNodes);
  for (int i = 0; i < kNodes; ++i) ring[i].push_back((i + 1) % kNodes);
  EXPECT_EQ(FindCycles(ring)[0].size(), 200'000u);
  EXPECT_TRUE(TopologicalOrder(ring).empty());

  Graph chain = ring;
  chain.back().clear();
  EXPECT_TRUE(FindCycles(chain).empty());
  EXPECT_EQ(TopologicalOrder(chain).back(), kNodes - 1);

  // Pairs that feed each other, each feeding all the way down a common chain.
  Graph combs(kNodes);
  const int half = kNodes / 2;
  for (int i = 0; i < half; ++i) {
    combs[i].push_back(i ^ 1);
    combs[i].push_back(half + i);
    if (i > 0) combs[half + i - 1].push_back(half + i);
  }
  EXPECT_EQ(FindCycles(combs).size(), 50'000u);
}

}  // namespace
}  // namespace vs
