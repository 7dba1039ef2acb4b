// Compiled for AVX2: Haswell, Zen and later.
#include "engine/stereo/cpu/kernels.h"

#if defined(__AVX2__)
#include "engine/stereo/cpu/simd_avx2.h"
// After Simd.
#include "engine/stereo/cpu/kernels_of.h"

namespace vs::cpu {

const Kernels* Avx2Kernels() {
  static constexpr Kernels kKernels = KernelSet<2, 4, 6, 7, 8>::Make("avx2");
  return __builtin_cpu_supports("avx2") ? &kKernels : nullptr;
}

}  // namespace vs::cpu
#else
const vs::cpu::Kernels* vs::cpu::Avx2Kernels() { return nullptr; }
#endif
