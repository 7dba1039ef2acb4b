// The loops of filter_kernels.h over the compiler's own vectors. Included by one file for
// each instruction set; like cpu/kernels_of.h it must not use what the linker could share.
#pragma once

#include <cstdint>

#include "engine/stereo/filter_kernels.h"

namespace {

// Pixels that are filtered at a time, side by side: one register of this instruction set.
#if defined(__AVX512BW__)
constexpr int kRegisterBytes = 64;
#elif defined(__AVX2__)
constexpr int kRegisterBytes = 32;
#else
constexpr int kRegisterBytes = 16;
#endif
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

// The median of kCount values in each lane. By forgetful selection: of any kCount / 2 + 2 values
// neither the least nor the greatest can be the median, so both are forgotten and one value more is
// looked at, until one is left.
template <int kCount>
inline Lanes MedianOf(Lanes (&values)[kCount]) {
  int first = 0;
  int last = kCount / 2 + 1;
  for (int next = last + 1; last - first >= 2; ++next) {
    for (int k = first + 1; k <= last; ++k) Order(values[first], values[k]);
    for (int k = first + 1; k < last; ++k) Order(values[k], values[last]);
    ++first;
    if (next < kCount) {
      values[last] = values[next];
    } else {
      --last;
    }
  }
  return values[first];
}

template <int kSize>
void MedianRow(const uint16_t* const* rows, int width, uint16_t* out) {
  Lanes values[kSize * kSize];
  for (int x = 0; x < width; x += kLaneCount) {
    for (int k = 0; k < kSize * kSize; ++k) {
      values[k] = LoadLanes(rows[k / kSize] + x + k % kSize - kSize / 2);
    }
    PutLanes(MedianOf(values), x, width, out);
  }
}

constexpr int kGatedSize = 5;
constexpr int kGatedCount = kGatedSize * kGatedSize;

// The value of rank count / 2 in each lane, found bit by bit from the top: the greatest value that
// at most count / 2 members lie below.
inline Lanes SelectMedian(const Lanes (&members)[kGatedCount], const Lanes& rank, int top_bit) {
  Lanes median = {};
  for (int bit = top_bit; bit != 0; bit >>= 1) {
    const Lanes limit = median | AllLanes(bit);
    Lanes below = {};
    for (const Lanes& value : members) below -= static_cast<Lanes>(value < limit);
    median = below <= rank ? limit : median;
  }
  return median;
}

void GatedMedianRow(const uint16_t* const* rows, const uint16_t* const* greys, int width, int gate,
                    int greatest, uint16_t* out) {
  int top_bit = 1;
  while (top_bit * 2 <= greatest) top_bit *= 2;
  const Lanes low = AllLanes(gate);
  const Lanes span = AllLanes(2 * gate);
  for (int x = 0; x < width; x += kLaneCount) {
    // Members keep their disparity, the others become greater than any.
    Lanes members[kGatedCount];
    Lanes count = {};
    const Lanes centre = LoadLanes(greys[kGatedSize / 2] + x) - low;
    for (int k = 0; k < kGatedCount; ++k) {
      const int from = x + k % kGatedSize - kGatedSize / 2;
      const Lanes disparity = LoadLanes(rows[k / kGatedSize] + from);
      // -gate <= step <= gate in one comparison of unsigned numbers.
      const Lanes step = LoadLanes(greys[k / kGatedSize] + from) - centre;
      const auto absent = static_cast<Lanes>((step > span) | (disparity == 0));
      members[k] = disparity | absent;
      count += absent + 1;  // absent is 0 or 0xffff
    }
    PutLanes(SelectMedian(members, count >> 1, top_bit), x, width, out);
  }
}

constexpr vs::FilterKernels kFilterKernels = {&MedianRow<3>, &MedianRow<5>, &GatedMedianRow};

}  // namespace
