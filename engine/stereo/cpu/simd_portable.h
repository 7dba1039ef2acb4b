#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace {

// Some bytes side by side, and what the kernels do with them. This one is 16 bytes by the
// compiler's own vectors, for any processor (SSE2, NEON ... or none); the others have the same
// members.
struct Simd {
  static constexpr int kLanes = 16;
  static constexpr int kRegisters = 16;
  using V = uint8_t __attribute__((vector_size(16)));
  using Pairs = uint16_t __attribute__((vector_size(16)));

  // From and to addresses that are multiples of kLanes, or any.
  static V Load(const uint8_t* p) { return *reinterpret_cast<const V*>(p); }
  static V LoadAnywhere(const uint8_t* p) {
    V a;
    std::memcpy(&a, p, sizeof a);
    return a;
  }
  static void Store(uint8_t* p, V a) { *reinterpret_cast<V*>(p) = a; }
  static void StoreAnywhere(uint8_t* p, V a) { std::memcpy(p, &a, sizeof a); }
  // Store past the caches, where the processor can; EndStream before others may read it.
  static void Stream(uint8_t* p, V a) { Store(p, a); }
  static void EndStream() {}
  static V Set(uint8_t a) { return V{} + a; }
  // Lane k is last[-k * n].
  template <int n>
  static V EveryNth(const uint8_t* last) {
    V a;
    for (int k = 0; k < kLanes; ++k) a[k] = last[-ptrdiff_t{k} * n];
    return a;
  }

  static V Min(V a, V b) { return a < b ? a : b; }
  static V Max(V a, V b) { return a > b ? a : b; }
  static V Add(V a, V b) { return a + b; }
  static V AddSaturated(V a, V b) {
    const V sum = a + b;
    return sum | static_cast<V>(sum < a);
  }
  static V Subtract(V a, V b) { return a - b; }
  static V SubtractSaturated(V a, V b) { return Max(a, b) - b; }
  // Of bytes with a sign.
  static V Magnitude(V a) { return Min(a, V{} - a); }
  static V Average(V a, V b) { return (a | b) - (((a ^ b) >> 1) & Set(0x7f)); }
  static V Xor(V a, V b) { return a ^ b; }
  static V Or(V a, V b) { return a | b; }
  static V BitCount(V a) {
    a = a - ((a >> 1) & Set(0x55));
    a = (a & Set(0x33)) + ((a >> 2) & Set(0x33));
    return (a + (a >> 4)) & Set(0x0f);
  }
  static V BitCountOfThree(V a, V b, V c) { return BitCount(a) + BitCount(b) + BitCount(c); }

  // Lane by lane `yes` or `no`.
  static V IfEqual(V a, V b, V yes, V no) { return a == b ? yes : no; }
  static V IfLess(V a, V b, V yes, V no) { return a < b ? yes : no; }
  // Where a < least: least = a, index = of_a. TakeLeast takes equal ones, too.
  static void TakeLess(V a, V of_a, V* least, V* index) {
    *index = a < *least ? of_a : *index;
    *least = Min(a, *least);
  }
  static void TakeLeast(V a, V of_a, V* least, V* index) {
    *index = *least < a ? *index : of_a;
    *least = Min(a, *least);
  }

  // Min(a, b), but a in the excepted lane.
  using Exception = uint8_t;
  static constexpr Exception kNoException = 255;
  static constexpr Exception Except(int lane) { return static_cast<Exception>(lane); }
  static V MinBut(V a, V b, Exception lane) {
    const V numbers = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    return Min(a, b | static_cast<V>(numbers == Set(lane)));
  }

  // Each lane from the lane below (above) it; `guard` in the lane that has none.
  static V FromBelow(V a, uint8_t guard) {
    return __builtin_shufflevector(a, Set(guard), 16, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13,
                                   14);
  }
  static V FromAbove(V a, uint8_t guard) {
    return __builtin_shufflevector(a, Set(guard), 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15,
                                   16);
  }

  // The least lane, in all lanes, or by itself.
  static V LeastOfAll(V a) {
    a = Min(a, __builtin_shufflevector(a, a, 8, 9, 10, 11, 12, 13, 14, 15, 0, 1, 2, 3, 4, 5, 6, 7));
    a = Min(a, __builtin_shufflevector(a, a, 4, 5, 6, 7, 0, 1, 2, 3, 12, 13, 14, 15, 8, 9, 10, 11));
    a = Min(a, __builtin_shufflevector(a, a, 2, 3, 0, 1, 6, 7, 4, 5, 10, 11, 8, 9, 14, 15, 12, 13));
    return Min(a,
               __builtin_shufflevector(a, a, 1, 0, 3, 2, 5, 4, 7, 6, 9, 8, 11, 10, 13, 12, 15, 14));
  }
  static uint8_t LeastByte(V a) { return LeastOfAll(a)[0]; }
  // Half of the lanes of two vectors as pairs of bytes, each a number of sixteen bits with the
  // first argument above the second (on a little-endian machine).
  static V PairLow(V high, V low) {
    return __builtin_shufflevector(low, high, 0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7,
                                   23);
  }
  static V PairHigh(V high, V low) {
    return __builtin_shufflevector(low, high, 8, 24, 9, 25, 10, 26, 11, 27, 12, 28, 13, 29, 14, 30,
                                   15, 31);
  }
  static V MinPairs(V a, V b) {
    const Pairs x = reinterpret_cast<Pairs>(a);
    const Pairs y = reinterpret_cast<Pairs>(b);
    return reinterpret_cast<V>(x < y ? x : y);
  }
  static int LeastPair(V a) {
    const Pairs pairs = reinterpret_cast<Pairs>(a);
    int least = pairs[0];
    for (int k = 1; k < kLanes / 2; ++k) least = pairs[k] < least ? pairs[k] : least;
    return least;
  }
  // A bit for each lane, the first one lowest: whether it is 0.
  static uint64_t ZeroLanes(V a) {
    const V bits = {1, 2, 4, 8, 16, 32, 64, 128, 1, 2, 4, 8, 16, 32, 64, 128};
    const V found = static_cast<V>(a == V{}) & bits;
    uint64_t halves[2];
    std::memcpy(halves, &found, sizeof halves);
    // The sum of a half's bytes comes out at the top.
    constexpr uint64_t kOnes = 0x0101010101010101;
    return (halves[0] * kOnes >> 56) | (halves[1] * kOnes >> 56 << 8);
  }
  // The first and the last lane.
  static uint8_t First(V a) { return a[0]; }
  static uint8_t Last(V a) { return a[kLanes - 1]; }
};

}  // namespace
