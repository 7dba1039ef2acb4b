#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

namespace vs {

// The last 256 of a row of times or durations in nanoseconds. One thread adds (one after the
// other), any may read meanwhile; takes no memory.
class RecentTimes {
 public:
  void Add(int64_t ns) {
    const uint64_t count = count_.load(std::memory_order_relaxed);
    ring_[count % kSize].store(ns, std::memory_order_relaxed);
    count_.store(count + 1, std::memory_order_release);
  }

  // 0 before the first.
  int64_t Last() const {
    const uint64_t count = count_.load(std::memory_order_acquire);
    return count == 0 ? 0 : ring_[(count - 1) % kSize].load(std::memory_order_relaxed);
  }

  // Oldest first.
  std::vector<int64_t> All() const {
    const uint64_t count = count_.load(std::memory_order_acquire);
    std::vector<int64_t> all;
    for (uint64_t i = count < kSize ? 0 : count - kSize; i < count; ++i) {
      all.push_back(ring_[i % kSize].load(std::memory_order_relaxed));
    }
    return all;
  }

 private:
  static constexpr uint64_t kSize = 256;

  std::array<std::atomic<int64_t>, kSize> ring_{};
  std::atomic<uint64_t> count_{0};
};

// The smallest value that at least `percent` of `values` do not exceed (nearest rank); 0 of none.
int64_t Percentile(std::vector<int64_t> values, int percent);

// How many per second, of things that happened at `times_ns` (ascending), as seen at `now_ns` and
// over the last two seconds. Falls when the next one is overdue; 0 when nothing happened lately.
double RatePerSecond(const std::vector<int64_t>& times_ns, int64_t now_ns);

}  // namespace vs
