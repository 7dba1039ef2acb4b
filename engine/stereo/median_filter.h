#pragma once

#include <cstdint>
#include <vector>

#include "engine/image/disparity_map.h"
#include "engine/stereo/filter_kernels.h"

namespace vs {

// Median of the size x size stored disparities around each pixel (size 3 or 5), where an invalid
// one counts as 0 and pixels beyond the border equal the nearest inside. So a lone hole is closed
// and a lone value removed: an invalid pixel whose median is not 0 takes it with kFilledConfidence;
// a valid one whose median is 0 becomes invalid (kFiltered). Else reason and confidence are kept.
//
// Writes rows [begin, end) of `out`, which has the size of `in` and shares no memory with it.
// `scratch` keeps memory between calls; one per thread.
void MedianFilterRows(const DisparityMap& in, int size, int begin, int end,
                      std::vector<uint16_t>* scratch, DisparityMap* out,
                      const FilterKernels& kernels = PlainFilterKernels());

}  // namespace vs
