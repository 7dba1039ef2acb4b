// Compiled for AVX-512 with BW, VBMI and BITALG: Ice Lake, Zen 4 and later.
#include "engine/stereo/cpu/kernels.h"

#if defined(__AVX512BITALG__)
#include "engine/stereo/cpu/simd_avx512.h"
// After Simd.
#include "engine/stereo/cpu/kernels_of.h"

namespace vs::cpu {

const Kernels* Avx512Kernels() {
  static constexpr Kernels kKernels = KernelSet<1, 2, 3, 4>::Make("avx512");
  const bool can = __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl") &&
                   __builtin_cpu_supports("avx512vbmi") && __builtin_cpu_supports("avx512bitalg");
  return can ? &kKernels : nullptr;
}

}  // namespace vs::cpu
#else
const vs::cpu::Kernels* vs::cpu::Avx512Kernels() { return nullptr; }
#endif
