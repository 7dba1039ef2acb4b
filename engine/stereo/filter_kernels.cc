#include "engine/stereo/filter_kernels.h"

#include "engine/stereo/filter_kernels_of.h"

namespace vs {

const FilterKernels& PlainFilterKernels() { return kFilterKernels; }

}  // namespace vs
