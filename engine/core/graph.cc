#include "engine/core/graph.h"

#include <algorithm>
#include <functional>
#include <queue>

namespace vs {
namespace {

std::vector<int> CountUpstream(const Graph& graph) {
  std::vector<int> count(graph.size(), 0);
  for (const std::vector<int>& downstream : graph) {
    for (const int node : downstream) ++count[node];
  }
  return count;
}

class CycleFinder {
 public:
  explicit CycleFinder(const Graph& graph)
      : graph_(graph),
        waiting_(CountUpstream(graph)),
        upstream_(graph.size()),
        done_(graph.size(), false),
        place_in_walk_(graph.size(), -1) {
    for (size_t node = 0; node < graph.size(); ++node) {
      for (const int to : graph[node]) upstream_[to].push_back(static_cast<int>(node));
      if (waiting_[node] == 0) free_.push_back(static_cast<int>(node));
    }
  }

  std::vector<std::vector<int>> Find() {
    RemoveFree();
    for (size_t node = 0; node < graph_.size(); ++node) {
      if (!done_[node]) WalkBackFrom(static_cast<int>(node));
    }
    return std::move(cycles_);
  }

 private:
  // Removes what no cycle feeds.
  void RemoveFree() {
    while (!free_.empty()) {
      const int node = free_.back();
      free_.pop_back();
      done_[node] = true;
      for (const int to : graph_[node]) {
        if (--waiting_[to] == 0 && !done_[to]) free_.push_back(to);
      }
    }
  }

  // Every node that is left has an upstream node that is left, so a walk upstream meets itself.
  void WalkBackFrom(int start) {
    std::vector<int> walk;
    const auto step_to = [&](int node) {
      place_in_walk_[node] = static_cast<int>(walk.size());
      walk.push_back(node);
    };
    step_to(start);
    while (!walk.empty()) {
      const int node = walk.back();
      if (done_[node]) {
        place_in_walk_[node] = -1;
        walk.pop_back();
        continue;
      }
      while (done_[upstream_[node].back()]) upstream_[node].pop_back();
      const int before = upstream_[node].back();
      if (place_in_walk_[before] < 0) {
        step_to(before);
        continue;
      }
      std::vector<int> cycle(walk.begin() + place_in_walk_[before], walk.end());
      std::reverse(cycle.begin(), cycle.end());
      std::rotate(cycle.begin(), std::min_element(cycle.begin(), cycle.end()), cycle.end());
      for (const int member : cycle) done_[member] = true;
      free_ = cycle;
      cycles_.push_back(std::move(cycle));
      RemoveFree();
    }
  }

  const Graph& graph_;
  std::vector<int> waiting_;  // upstream edges from nodes that are left
  Graph upstream_;
  std::vector<bool> done_;
  std::vector<int> place_in_walk_;  // -1 = not in it
  std::vector<int> free_;
  std::vector<std::vector<int>> cycles_;
};

}  // namespace

std::vector<int> TopologicalOrder(const Graph& graph) {
  std::vector<int> waiting = CountUpstream(graph);
  std::priority_queue<int, std::vector<int>, std::greater<>> ready;
  for (size_t node = 0; node < graph.size(); ++node) {
    if (waiting[node] == 0) ready.push(static_cast<int>(node));
  }
  std::vector<int> order;
  order.reserve(graph.size());
  while (!ready.empty()) {
    order.push_back(ready.top());
    ready.pop();
    for (const int to : graph[order.back()]) {
      if (--waiting[to] == 0) ready.push(to);
    }
  }
  return order;
}

std::vector<std::vector<int>> FindCycles(const Graph& graph) { return CycleFinder(graph).Find(); }

}  // namespace vs
