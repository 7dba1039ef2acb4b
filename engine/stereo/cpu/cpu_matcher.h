#pragma once

#include <memory>

#include "engine/base/status.h"
#include "engine/stereo/cpu/kernels.h"
#include "engine/stereo/stereo_matcher.h"

namespace vs::cpu {

// The matcher "cpu" with certain kernels, for tests and benchmarks; NOT_FOUND for null, as
// Avx512Kernels() and the others are where they cannot run.
Result<std::unique_ptr<StereoMatcher>> MakeCpuMatcher(const Kernels* kernels);

}  // namespace vs::cpu
