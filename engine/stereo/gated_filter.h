#pragma once

#include <cstdint>
#include <vector>

#include "engine/image/disparity_map.h"
#include "engine/image/image.h"
#include "engine/stereo/filter_kernels.h"

namespace vs {

struct GatedFilterOptions {
  int gate = 20;  // grey levels, 0..255
  bool median = true;
  bool fill = true;
};

// Keeps its room between calls; one per thread.
struct GatedFilterScratch {
  std::vector<uint16_t> rows;
  std::vector<uint16_t> disparities;
  std::vector<uint16_t> greys;
};

// Filters that look only at pixels of the same surface: members of a window are its valid pixels,
// inside the picture, whose grey in the left picture differs from the centre's by at most `gate`.
// The median of n members is the one of rank n / 2, counting from 0, by rising disparity.
//
//   median  a valid pixel takes the median of its 5 x 5 window; its confidence stays.
//   fill    an invalid pixel with at least 12 members in its 7 x 7 window, of which at least 70 %
//           lie within 16 (1 px) of their median, takes that median with kFilledConfidence.
//
// Both look at `in` only, so the order does not matter. Writes rows [begin, end) of `out`, which
// has the size of `in` and shares no memory with it.
void GatedFilterRows(const DisparityMap& in, const GreyImage& left,
                     const GatedFilterOptions& options, int begin, int end,
                     GatedFilterScratch* memory, DisparityMap* out,
                     const FilterKernels& kernels = PlainFilterKernels());

}  // namespace vs
