#pragma once

#include <vector>

namespace vs {

// A directed graph: for each node the nodes that it feeds, an edge perhaps several times.
using Graph = std::vector<std::vector<int>>;

// All nodes of an acyclic graph so that each comes after those that feed it; of several that could
// come next the smallest. Of a graph with cycles, the nodes on cycles and behind them are missing.
// O((n + m) log n) for n nodes and m edges.
std::vector<int> TopologicalOrder(const Graph& graph);

// Cycles that share no node, each along its edges from its smallest node, so many that the graph
// would be acyclic without their nodes: one for each mistake in wiring. Empty for an acyclic graph.
// O(n + m), without recursion.
std::vector<std::vector<int>> FindCycles(const Graph& graph);

}  // namespace vs
