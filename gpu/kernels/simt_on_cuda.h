// simt.h for nvcc.
#pragma once

#include <cuda_runtime.h>

#include <cstdint>

// Kernels are static: each unit that includes them has its own.
#define VS_KERNEL static __global__ void
#define VS_DEVICE __device__ __forceinline__
#define VS_HOST_DEVICE __host__ __device__ __forceinline__
#define VS_SHARED __shared__
#define VS_UNROLL _Pragma("unroll")

namespace vs::gpu {

#define VS_ON_DEVICE static __device__ __forceinline__

VS_ON_DEVICE int ThreadsInBlock() { return static_cast<int>(blockDim.x); }
VS_ON_DEVICE int ThreadInBlock() { return static_cast<int>(threadIdx.x); }
VS_ON_DEVICE int BlockX() { return static_cast<int>(blockIdx.x); }
VS_ON_DEVICE int BlockY() { return static_cast<int>(blockIdx.y); }

VS_ON_DEVICE void SyncBlock() { __syncthreads(); }
VS_ON_DEVICE void SyncWarp() { __syncwarp(); }

inline constexpr unsigned kAllLanes = 0xffffffffU;

VS_ON_DEVICE uint32_t ShuffleUp(uint32_t v, int n) { return __shfl_up_sync(kAllLanes, v, n); }
VS_ON_DEVICE uint32_t ShuffleDown(uint32_t v, int n) { return __shfl_down_sync(kAllLanes, v, n); }
VS_ON_DEVICE uint32_t ShuffleXor(uint32_t v, int n) { return __shfl_xor_sync(kAllLanes, v, n); }
VS_ON_DEVICE uint32_t FromLane(uint32_t v, int lane) { return __shfl_sync(kAllLanes, v, lane); }

#if defined(__CUDA_ARCH__) && __CUDA_ARCH__ >= 800
VS_ON_DEVICE uint32_t WarpMin(uint32_t v) { return __reduce_min_sync(kAllLanes, v); }
VS_ON_DEVICE uint32_t WarpSum(uint32_t v) { return __reduce_add_sync(kAllLanes, v); }
#else
VS_ON_DEVICE uint32_t WarpMin(uint32_t v) {
  for (int n = 16; n > 0; n /= 2) v = min(v, ShuffleXor(v, n));
  return v;
}
VS_ON_DEVICE uint32_t WarpSum(uint32_t v) {
  for (int n = 16; n > 0; n /= 2) v += ShuffleXor(v, n);
  return v;
}
#endif

VS_ON_DEVICE uint32_t AtomicMin(uint32_t* at, uint32_t v) { return atomicMin(at, v); }
VS_ON_DEVICE uint32_t AtomicAdd(uint32_t* at, uint32_t v) { return atomicAdd(at, v); }
// What other threads wrote, not what this one remembers.
VS_ON_DEVICE uint32_t ReadShared(const uint32_t* at) {
  return *static_cast<const volatile uint32_t*>(at);
}

// Each operation is rounded: never a multiplication and a sum at once.
VS_ON_DEVICE float AddFloats(float a, float b) { return __fadd_rn(a, b); }
VS_ON_DEVICE float MultiplyFloats(float a, float b) { return __fmul_rn(a, b); }
VS_ON_DEVICE float DivideFloats(float a, float b) { return __fdiv_rn(a, b); }

VS_ON_DEVICE int CountBits(uint32_t v) { return __popc(v); }
VS_ON_DEVICE uint32_t BytePermute(uint32_t a, uint32_t b, uint32_t selector) {
  return __byte_perm(a, b, selector);
}
// Pairs of 16 bits: from sm_90 on these are meant to be one instruction each (DPX).
VS_ON_DEVICE uint32_t MinPairs(uint32_t a, uint32_t b) { return __vminu2(a, b); }
VS_ON_DEVICE uint32_t AddMinPairs(uint32_t a, uint32_t b, uint32_t c) {
  return __viaddmin_u16x2(a, b, c);
}

#undef VS_ON_DEVICE

}  // namespace vs::gpu
