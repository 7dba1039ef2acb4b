// A cell in registers, and what its bytes stand for. Part of kernels_of.h; see there.
#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/stereo/cpu/kernels.h"

#define VS_INLINE inline __attribute__((always_inline))

// NOLINTBEGIN(misc-definitions-in-headers): each file that includes this shall have its own.
// NOLINTBEGIN(bugprone-implicit-widening-of-multiplication-result): places within a cell.
namespace {

using vs::cpu::CensusRowWork;
using vs::cpu::CostKind;
using vs::cpu::CostRow;
using vs::cpu::kBeyond;
using vs::cpu::Kernels;
using vs::cpu::PenaltySteps;
using vs::cpu::Plan;
using vs::cpu::SweepMode;
using vs::cpu::SweepRow;
using vs::cpu::WindowRow;
using vs::cpu::WindowSums;
using V = Simd::V;

constexpr int kLanes = Simd::kLanes;
// Stands for the L of an index that does not exist: no less than any P2, and adding P1 to it does
// not wrap.
constexpr uint8_t kGuard = 127;

VS_INLINE int Clamp(int value, int low, int high) {
  return value < low ? low : value > high ? high : value;
}

// One cell in registers.
template <int kStripes>
struct Cell {
  V v[kStripes];

  VS_INLINE void Load(const uint8_t* p) {
#pragma GCC unroll 16
    for (int r = 0; r < kStripes; ++r) v[r] = Simd::Load(p + r * kLanes);
  }
  VS_INLINE void Store(uint8_t* p) const {
#pragma GCC unroll 16
    for (int r = 0; r < kStripes; ++r) Simd::Store(p + r * kLanes, v[r]);
  }
  VS_INLINE void Fill(uint8_t value) {
#pragma GCC unroll 16
    for (int r = 0; r < kStripes; ++r) v[r] = Simd::Set(value);
  }
};

// For any bytes.
VS_INLINE V AbsoluteDifference(V a, V b) {
  return Simd::Subtract(Simd::Max(a, b), Simd::Min(a, b));
}

// What each byte of a cell stands for.
template <int kStripes>
struct Layout {
  Cell<kStripes> index;   // i, within the range
  Cell<kStripes> beyond;  // 0xff where the index is beyond the range, else 0
  Cell<kStripes> least;   // kBeyond where the index is beyond the range, else 0
  Cell<kStripes>
      outside;  // the cost of a counterpart outside the picture, kBeyond beyond the range
  bool full;    // no index is beyond the range
  // Left pixels first_inside .. first_inside + inside_count - 1 have all their counterparts inside.
  int first_inside;
  unsigned inside_count;

  VS_INLINE explicit Layout(const Plan& plan)
      : full(plan.num_disparities == kStripes * kLanes),
        first_inside(plan.min_disparity + plan.num_disparities - 1),
        inside_count(
            static_cast<unsigned>(Clamp(plan.width - plan.num_disparities + 1, 0, plan.width))) {
    constexpr int kCell = kStripes * kLanes;
    index.Load(plan.layout);
    beyond.Load(plan.layout + kCell);
    outside.Load(plan.layout + 2 * kCell);
    for (int r = 0; r < kStripes; ++r) least.v[r] = Simd::Min(beyond.v[r], Simd::Set(kBeyond));
  }
};

inline void MakeLayout(const Plan& plan, uint8_t* out) {
  for (int k = 0; k < plan.cell; ++k) {
    const int i = k % kLanes * plan.stripes + k / kLanes;
    const bool within = i < plan.num_disparities;
    out[k] = static_cast<uint8_t>(i);
    out[plan.cell + k] = within ? 0 : 0xff;
    out[2 * plan.cell + k] = within ? plan.outside : kBeyond;
  }
}

// The indices whose counterpart of left pixel x lies inside the right picture.
struct Inside {
  int begin;
  int end;
};
VS_INLINE Inside InsideAt(const Plan& plan, int x) {
  const int first = x - plan.min_disparity;
  const int begin = Clamp(first - plan.width + 1, 0, plan.num_disparities);
  const int end = Clamp(first + 1, begin, plan.num_disparities);
  return {begin, end};
}

template <int kStripes>
VS_INLINE bool AllInside(const Layout<kStripes>& layout, int x) {
  return static_cast<unsigned>(x - layout.first_inside) < layout.inside_count;
}

// Puts the cost of the outside where the counterpart is outside.
template <int kStripes>
VS_INLINE void SetOutside(const Plan& plan, const Layout<kStripes>& layout, int x,
                          Cell<kStripes>* cost) {
  if (AllInside(layout, x)) return;
  const Inside inside = InsideAt(plan, x);
  if (inside.begin >= inside.end) {
    *cost = layout.outside;
    return;
  }
  const V last = Simd::Set(static_cast<uint8_t>(inside.end - 1));
  if (inside.begin == 0) {  // mostly: only a negative disparity leads out on the right
    for (int r = 0; r < kStripes; ++r) {
      cost->v[r] = Simd::IfLess(last, layout.index.v[r], layout.outside.v[r], cost->v[r]);
    }
    return;
  }
  const V first = Simd::Set(static_cast<uint8_t>(inside.begin));
  for (int r = 0; r < kStripes; ++r) {
    const V nearest = Simd::Min(Simd::Max(layout.index.v[r], first), last);
    cost->v[r] = Simd::IfEqual(nearest, layout.index.v[r], cost->v[r], layout.outside.v[r]);
  }
}

}  // namespace
// NOLINTEND(bugprone-implicit-widening-of-multiplication-result)
// NOLINTEND(misc-definitions-in-headers)
