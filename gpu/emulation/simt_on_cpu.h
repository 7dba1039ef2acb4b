// simt.h for a plain compiler: kernels run on the CPU, for tests. Included by simt.h alone.
//
// All threads of a block are fibers of the one thread that calls Run; they change places where they
// wait for each other or read what others write, in an order that is shuffled anew each time, and
// blocks run in a shuffled order too: a kernel that relies on an order, or forgets to wait, gives
// different results. What is not seen here is how quick it is and what the memory of a real device
// would do.
#pragma once

#include <array>
#include <cstdint>
#include <functional>

#define VS_KERNEL inline void
#define VS_DEVICE inline
#define VS_HOST_DEVICE inline
// One block runs at a time.
#define VS_SHARED static thread_local
#define VS_UNROLL _Pragma("GCC unroll 32")

namespace vs::gpu {

namespace emulation {

struct Place {
  int threads_in_block = 1;
  int thread = 0;
  int block_x = 0;
  int block_y = 0;
};
extern thread_local Place place;  // of the fiber that runs

// Runs `kernel` in each thread of each block of `grid`; `seed` shuffles.
void Run(Grid grid, int threads_in_block, uint32_t seed, const std::function<void()>& kernel);

// What all lanes of the caller's warp gave, once all have come here. Valid until the next but one.
using WarpValues = std::array<uint32_t, kWarpSize>;
const WarpValues& Exchange(uint32_t value);
void WaitForBlock();
// Now and then lets others of the block go on first.
void LetOthersRun();

}  // namespace emulation

inline int ThreadsInBlock() { return emulation::place.threads_in_block; }
inline int ThreadInBlock() { return emulation::place.thread; }
inline int BlockX() { return emulation::place.block_x; }
inline int BlockY() { return emulation::place.block_y; }

inline void SyncBlock() { emulation::WaitForBlock(); }
inline void SyncWarp() { emulation::Exchange(0); }

inline uint32_t FromLane(uint32_t v, int lane) {
  return emulation::Exchange(v)[static_cast<size_t>(lane % kWarpSize)];
}
// Lanes that would look beyond the warp keep their own value, as on the device.
inline uint32_t ShuffleUp(uint32_t v, int n) {
  const int lane = emulation::place.thread % kWarpSize;
  return FromLane(v, lane < n ? lane : lane - n);
}
inline uint32_t ShuffleDown(uint32_t v, int n) {
  const int lane = emulation::place.thread % kWarpSize;
  return FromLane(v, lane + n < kWarpSize ? lane + n : lane);
}
inline uint32_t ShuffleXor(uint32_t v, int n) {
  return FromLane(v, (emulation::place.thread % kWarpSize) ^ n);
}
inline uint32_t WarpMin(uint32_t v) {
  uint32_t least = v;
  for (const uint32_t other : emulation::Exchange(v)) least = other < least ? other : least;
  return least;
}
inline uint32_t WarpSum(uint32_t v) {
  uint32_t sum = 0;
  for (const uint32_t other : emulation::Exchange(v)) sum += other;
  return sum;
}

inline uint32_t AtomicMin(uint32_t* at, uint32_t v) {
  const uint32_t before = *at;
  if (v < before) *at = v;
  return before;
}
inline uint32_t AtomicAdd(uint32_t* at, uint32_t v) {
  const uint32_t before = *at;
  *at += v;
  return before;
}
// May be old before the reader does anything with it, as on the device.
inline uint32_t ReadShared(const uint32_t* at) {
  const uint32_t value = *at;
  emulation::LetOthersRun();
  return value;
}

// Needs -ffp-contract=off where a CPU could do two at once.
inline float AddFloats(float a, float b) { return a + b; }
inline float MultiplyFloats(float a, float b) { return a * b; }
inline float DivideFloats(float a, float b) { return a / b; }

inline int CountBits(uint32_t v) { return __builtin_popcount(v); }
// Byte k of the result is byte (selector >> 4 k) & 7 of the eight bytes of a and then b.
inline uint32_t BytePermute(uint32_t a, uint32_t b, uint32_t selector) {
  const uint64_t bytes = (uint64_t{b} << 32) | a;
  uint32_t out = 0;
  for (int k = 0; k < 4; ++k) {
    const uint32_t which = (selector >> (4 * k)) & 7;
    out |= static_cast<uint32_t>((bytes >> (8 * which)) & 0xff) << (8 * k);
  }
  return out;
}
inline uint32_t MinPairs(uint32_t a, uint32_t b) {
  const uint32_t low = (a & 0xffff) < (b & 0xffff) ? a & 0xffff : b & 0xffff;
  const uint32_t high = (a >> 16) < (b >> 16) ? a >> 16 : b >> 16;
  return high << 16 | low;
}
inline uint32_t AddMinPairs(uint32_t a, uint32_t b, uint32_t c) { return MinPairs(a + b, c); }

}  // namespace vs::gpu
