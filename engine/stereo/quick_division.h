#pragma once

#include <array>
#include <cstdint>

namespace vs {

inline constexpr int kLargestDivisor = 1020;

// a / b in integers by one multiplication, for b of 1..kLargestDivisor, a >= 0 and a * b <= 2^24.
//
// With r = ceil(2^24 / b) = (2^24 + e) / b, 0 <= e < b, a * r / 2^24 exceeds a / b by
// a * e / (b * 2^24), which is less than 1 / b, and so less than what is missing to the next
// integer.
inline int QuickDivide(int a, int b) {
  static constexpr auto kReciprocals = [] {
    std::array<uint32_t, kLargestDivisor + 1> reciprocals = {};
    for (uint32_t n = 1; n <= kLargestDivisor; ++n) reciprocals[n] = ((1U << 24) + n - 1) / n;
    return reciprocals;
  }();
  return static_cast<int>((static_cast<uint64_t>(a) * kReciprocals[static_cast<uint32_t>(b)]) >>
                          24);
}

}  // namespace vs
