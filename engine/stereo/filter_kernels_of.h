// The loops of filter_kernels.h over the compiler's own vectors, or plain ones that it makes
// vectors of. Included by one file for each instruction set; like cpu/kernels_of.h it must not use
// what the linker could share.
#pragma once

#include <cstdint>

#include "engine/stereo/filter_kernels.h"
#include "engine/stereo/judge_kernel_of.h"

// NOLINTBEGIN(misc-definitions-in-headers): each file that includes this shall have its own.
namespace {

// Pixels that are filtered at a time, side by side.
using Lanes = uint16_t __attribute__((vector_size(kRegisterBytes)));
constexpr int kLaneCount = kRegisterBytes / 2;
static_assert(kLaneCount <= vs::kFilterLanes);

inline Lanes LoadLanes(const uint16_t* from) {
  Lanes lanes;
  __builtin_memcpy(&lanes, from, sizeof lanes);
  return lanes;
}

inline Lanes AllLanes(int value) { return Lanes{} + static_cast<uint16_t>(value); }

inline void PutLanes(const Lanes& lanes, int x, int width, uint16_t* out) {
  if (x + kLaneCount <= width) {
    __builtin_memcpy(out + x, &lanes, sizeof lanes);
  } else {
    for (int k = 0; x + k < width; ++k) out[x + k] = lanes[k];
  }
}

inline void Order(Lanes& low, Lanes& high) {
  const Lanes less = low < high ? low : high;
  high = low < high ? high : low;
  low = less;
}

// Orders values[kFirst .. kLast] just so far that the least comes first and the greatest last.
template <int kFirst, int kLast, int kCount>
inline __attribute__((always_inline)) void FindEnds(Lanes (&values)[kCount]) {
#pragma GCC unroll 16
  for (int k = 0; kFirst + k < kLast - k; ++k) Order(values[kFirst + k], values[kLast - k]);
    // The lesser ones are now in the first half, the greater ones in the second; a middle one in
    // both.
#pragma GCC unroll 16
  for (int k = kFirst + 1; k <= (kFirst + kLast) / 2; ++k) Order(values[kFirst], values[k]);
#pragma GCC unroll 16
  for (int k = (kFirst + kLast + 1) / 2; k < kLast; ++k) Order(values[k], values[kLast]);
}

// The median of kCount values (an odd number) in each lane. By forgetful selection: of any
// kCount / 2 + 2 values neither the least nor the greatest can be the median, so both are forgotten
// and one value more is looked at, until one is left. All indices are known when this is compiled,
// so that the values stay in registers.
template <int kCount, int kFirst = 0>
inline __attribute__((always_inline)) Lanes MedianOf(Lanes (&values)[kCount]) {
  // Each round looks at one value less: kFirst .. kLast, of which the last one is new.
  constexpr int kLast = kCount / 2 + 1;
  if constexpr (kFirst == kLast - 1) {
    return values[kFirst];
  } else {
    FindEnds<kFirst, kLast>(values);
    // The greatest gives its place to the next value; the least is left behind.
    constexpr int kNext = kLast + 1 + kFirst;
    if constexpr (kNext < kCount) values[kLast] = values[kNext];
    return MedianOf<kCount, kFirst + 1>(values);
  }
}

template <int kSize>
void MedianRow(const uint16_t* const* rows, int width, uint16_t* out) {
  Lanes values[kSize * kSize];
  for (int x = 0; x < width; x += kLaneCount) {
#pragma GCC unroll 25
    for (int k = 0; k < kSize * kSize; ++k) {
      values[k] = LoadLanes(rows[k / kSize] + x + k % kSize - kSize / 2);
    }
    PutLanes(MedianOf(values), x, width, out);
  }
}

// The window's pixels that are no members become, in turn, greater and less than any member. So
// the median of all is the member of rank count / 2.
void GatedMedianRow(const uint16_t* const* rows, const uint16_t* const* greys, int width, int gate,
                    uint16_t* out) {
  constexpr int kSize = 5;
  const Lanes low = AllLanes(gate);
  const Lanes span = AllLanes(2 * gate);
  for (int x = 0; x < width; x += kLaneCount) {
    Lanes values[kSize * kSize];
    Lanes stand_in = {};
    const Lanes centre = LoadLanes(greys[kSize / 2] + x) - low;
#pragma GCC unroll 25
    for (int k = 0; k < kSize * kSize; ++k) {
      const int from = x + k % kSize - kSize / 2;
      const Lanes disparity = LoadLanes(rows[k / kSize] + from);
      // -gate <= step <= gate in one comparison of unsigned numbers.
      const Lanes step = LoadLanes(greys[k / kSize] + from) - centre;
      const auto absent = static_cast<Lanes>((step > span) | (disparity == 0));
      stand_in ^= absent;
      values[k] = (disparity & ~absent) | (stand_in & absent);
    }
    PutLanes(MedianOf(values), x, width, out);
  }
}

constexpr vs::FilterKernels kFilterKernels = {&Judge, &MedianRow<3>, &MedianRow<5>,
                                              &GatedMedianRow};

}  // namespace
// NOLINTEND(misc-definitions-in-headers)
