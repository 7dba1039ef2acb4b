#include "engine/stereo/quick_division.h"

#include <gtest/gtest.h>

namespace vs {
namespace {

TEST(QuickDivide, EqualsTheDivision) {
  for (int b = 1; b <= kLargestDivisor; ++b) {
    // Wherever the quotient changes.
    for (int q = 1; q * b <= (1 << 24) / b; ++q) {
      ASSERT_EQ(QuickDivide(q * b, b), q) << b;
      ASSERT_EQ(QuickDivide(q * b - 1, b), q - 1) << b;
    }
    ASSERT_EQ(QuickDivide((1 << 24) / b, b), (1 << 24) / b / b) << b;
  }
}

}  // namespace
}  // namespace vs
