// The loops of filter_kernels.h over the compiler's own vectors, or plain ones that it makes
// vectors of. Included by one file for each instruction set; like cpu/kernels_of.h it must not use
// what the linker could share.
#pragma once

#include <cstdint>

#include "engine/stereo/filter_kernels.h"

// NOLINTBEGIN(misc-definitions-in-headers): each file that includes this shall have its own.
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

using Ints = int32_t __attribute__((vector_size(kRegisterBytes)));
using Floats = float __attribute__((vector_size(kRegisterBytes)));
constexpr int kIntCount = kRegisterBytes / 4;
static_assert(kIntCount <= vs::kMinPictureSize);

inline Ints LoadInts(const uint8_t* from) {
  int32_t values[kIntCount];
  for (int k = 0; k < kIntCount; ++k) values[k] = from[k];
  Ints ints;
  __builtin_memcpy(&ints, values, sizeof ints);
  return ints;
}

template <class T>
inline void StoreInts(const Ints& ints, T* to) {
  int32_t values[kIntCount];
  __builtin_memcpy(values, &ints, sizeof ints);
  T narrow[kIntCount];
  for (int k = 0; k < kIntCount; ++k) narrow[k] = static_cast<T>(values[k]);
  __builtin_memcpy(to, narrow, sizeof narrow);
}

// a / b in integers, for a of 0..2^17 and b of 1..2^10, by the division of floats. Exact: both are
// floats, and a quotient that is no integer is at least 1 / b below the next one, more than
// rounding can add.
inline Ints Quotient(Ints a, Ints b) {
  return __builtin_convertvector(
      __builtin_convertvector(a, Floats) / __builtin_convertvector(b, Floats), Ints);
}

// See selection.h.
template <vs::SubPixel kMethod>
inline Ints SubPixelSixteenths(Ints before, Ints best, Ints after) {
  if constexpr (kMethod == vs::SubPixel::kOff) return Ints{};
  const Ints divisor = kMethod == vs::SubPixel::kEquiangular
                           ? (before > after ? before : after) - best
                           : before + after - 2 * best;
  // floor((2 n + divisor) / (2 divisor)), made positive for the integer division: n >= -8 divisor.
  const Ints numerator = 16 * (before - after) + 17 * divisor;
  const Ints some = divisor > 0 ? 2 * divisor : Ints{} + 1;
  return divisor > 0 ? Quotient(numerator, some) - 8 : Ints{};
}

template <vs::SubPixel kMethod>
void MeasureWinners(const vs::MeasureRow& row) {
  const vs::WinnerRow winners = row.winners;
  const int width = row.width;
  for (int x = 0; x < width; x += kIntCount) {
    // The last piece ends with the row.
    const int from = x + kIntCount <= width ? x : width - kIntCount;
    const Ints index = LoadInts(winners.index + from);
    const Ints best = LoadInts(winners.best + from);
    const Ints second = LoadInts(winners.second + from);
    const Ints sixteenths = SubPixelSixteenths<kMethod>(LoadInts(winners.before + from), best,
                                                        LoadInts(winners.after + from));
    const Ints between = (index > 0) & (index < Ints{} + row.last_index);
    const Ints margin = Quotient(255 * (second - best), second > 0 ? second : Ints{} + 1);
    StoreInts(row.first_stored + 16 * index + (between & sixteenths), row.disparity + from);
    StoreInts(margin, row.confidence + from);
  }
}

void Measure(const vs::MeasureRow& row) {
  switch (row.sub_pixel) {
    case vs::SubPixel::kOff:
      return MeasureWinners<vs::SubPixel::kOff>(row);
    case vs::SubPixel::kParabola:
      return MeasureWinners<vs::SubPixel::kParabola>(row);
    case vs::SubPixel::kEquiangular:
      return MeasureWinners<vs::SubPixel::kEquiangular>(row);
  }
}

constexpr vs::FilterKernels kFilterKernels = {&Measure, &MedianRow<3>, &MedianRow<5>,
                                              &GatedMedianRow};

}  // namespace
// NOLINTEND(misc-definitions-in-headers)
