// The words that kernels are written in. nvcc makes CUDA's own of them. A plain compiler makes them
// calls of the emulation, which runs the same kernels on the CPU, thread by thread, so that tests
// need no device (emulation/simt_on_cpu.h).
//
// Blocks are one-dimensional; grids have x and y. A block has whole warps of 32 threads, and every
// thread reaches every Sync... and Warp... call, so no kernel returns early before one.
#pragma once

#include <cstdint>

namespace vs::gpu {

inline constexpr int kWarpSize = 32;

// How many blocks a kernel is launched with.
struct Grid {
  int x = 1;
  int y = 1;
};

}  // namespace vs::gpu

#ifdef __CUDACC__
#include "gpu/kernels/simt_on_cuda.h"
#else
#include "gpu/emulation/simt_on_cpu.h"
#endif

namespace vs::gpu {

// Two numbers of 16 bits in one word. No sum may exceed 65535.
VS_HOST_DEVICE uint32_t Both(uint32_t value) { return value * 0x10001U; }
VS_HOST_DEVICE uint32_t AddPairs(uint32_t a, uint32_t b) { return a + b; }
VS_HOST_DEVICE uint32_t SubtractPairs(uint32_t a, uint32_t b) {
  return a - b;
}  // no b greater than its a

// Where this thread is in the whole launch, when a grid is as wide as there are things to do.
VS_DEVICE int ThreadInGrid() { return BlockX() * ThreadsInBlock() + ThreadInBlock(); }
VS_DEVICE int Lane() { return ThreadInBlock() % kWarpSize; }
VS_DEVICE int WarpInBlock() { return ThreadInBlock() / kWarpSize; }
VS_DEVICE int WarpsInBlock() { return ThreadsInBlock() / kWarpSize; }

VS_HOST_DEVICE int Clamp(int value, int low, int high) {
  return value < low ? low : value > high ? high : value;
}
template <class T>
VS_HOST_DEVICE T Lesser(T a, T b) {
  return b < a ? b : a;
}
template <class T>
VS_HOST_DEVICE T Greater(T a, T b) {
  return a < b ? b : a;
}
VS_HOST_DEVICE int Distance(int a, int b) { return a < b ? b - a : a - b; }

}  // namespace vs::gpu
