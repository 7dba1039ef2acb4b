// For every other processor.
#include "engine/stereo/cpu/simd_portable.h"
// After Simd.
#include "engine/stereo/cpu/kernels_of.h"

namespace vs::cpu {

const Kernels* PortableKernels() {
  static constexpr Kernels kKernels = KernelSet<4, 8, 12, 16>::Make("portable");
  return &kKernels;
}

}  // namespace vs::cpu
