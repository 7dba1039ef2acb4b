// The kernels of kernels.h over the vector operations of `Simd`. Included by one file for each
// instruction set, after its simd_*.h. Everything is in an unnamed namespace and nothing of the
// standard library is used that could become a function of its own: the linker keeps one copy of
// such a function for the whole program, and it might keep this one.
#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/stereo/cpu/kernels.h"
#include "engine/stereo/filter_kernels_of.h"

#define VS_INLINE inline __attribute__((always_inline))

// NOLINTBEGIN(misc-definitions-in-headers): each file that includes this shall have its own.
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

VS_INLINE int Distance(int a, int b) { return a > b ? a - b : b - a; }

// One cell in registers.
template <int kStripes>
struct Cell {
  V v[kStripes];

  VS_INLINE void Load(const uint8_t* p) {
    for (int r = 0; r < kStripes; ++r) v[r] = Simd::Load(p + r * kLanes);
  }
  VS_INLINE void Store(uint8_t* p) const {
    for (int r = 0; r < kStripes; ++r) Simd::Store(p + r * kLanes, v[r]);
  }
  VS_INLINE void Fill(uint8_t value) {
    for (int r = 0; r < kStripes; ++r) v[r] = Simd::Set(value);
  }
};

VS_INLINE V AbsoluteDifference(V a, V b) {
  return Simd::Subtract(Simd::Max(a, b), Simd::Min(a, b));
}

inline void ComputeCensusRow(const CensusRowWork& work) {
  for (int x = 0; x < work.width; x += kLanes) {
    // The last piece ends with the row.
    const int from = x + kLanes <= work.width ? x : work.width - kLanes;
    const V centre = Simd::LoadAnywhere(work.centre + from);
    for (int n = 0; n < work.count; n += 8) {
      V code = Simd::Set(0);
      for (int b = 0; b < 8 && n + b < work.count; ++b) {
        const V neighbour = Simd::LoadAnywhere(work.centre + work.neighbours[n + b] + from);
        const V bit = Simd::Set(static_cast<uint8_t>(1 << b));
        code = Simd::Or(code, Simd::IfLess(neighbour, centre, bit, Simd::Set(0)));
      }
      Simd::StoreAnywhere(work.codes + static_cast<size_t>(n / 8) * work.width + from, code);
    }
  }
}

inline void ComputePenaltyRow(const PenaltySteps& steps, const uint8_t* grey, const uint8_t* from,
                              int count, uint8_t* p2) {
  const V one = Simd::Set(1);
  for (int x = 0; x < count; x += kLanes) {
    const V step = AbsoluteDifference(Simd::LoadAnywhere(grey + x), Simd::LoadAnywhere(from + x));
    V penalty = Simd::Set(steps.penalty);
    for (int k = 0; k < steps.count; ++k) {
      const V below = Simd::Set(static_cast<uint8_t>(steps.limits[k] - 1));
      penalty = Simd::Subtract(penalty, Simd::Min(Simd::SubtractSaturated(step, below), one));
    }
    Simd::StoreAnywhere(p2 + x, penalty);
  }
}

// What each byte of a cell stands for.
template <int kStripes>
struct Layout {
  Cell<kStripes> index;   // i, within the range
  Cell<kStripes> beyond;  // 0xff where the index is beyond the range, else 0
  Cell<kStripes> least;   // kBeyond where the index is beyond the range, else 0
  Cell<kStripes>
      outside;  // the cost of a counterpart outside the picture, kBeyond beyond the range
  // Left pixels first_inside .. first_inside + inside_count - 1 have all their counterparts inside.
  int first_inside;
  unsigned inside_count;

  VS_INLINE explicit Layout(const Plan& plan)
      : first_inside(plan.min_disparity + plan.num_disparities - 1),
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
  const V first = Simd::Set(static_cast<uint8_t>(inside.begin));
  const V last = Simd::Set(static_cast<uint8_t>(inside.end - 1));
  for (int r = 0; r < kStripes; ++r) {
    const V nearest = Simd::Min(Simd::Max(layout.index.v[r], first), last);
    cost->v[r] = Simd::IfEqual(nearest, layout.index.v[r], cost->v[r], layout.outside.v[r]);
  }
}

// Where the counterparts of a left pixel lie in the first plane of a row of the right view, by
// stripe. One pixel farther every place is one less, so that a stripe moves on to where the stripe
// before it was.
template <int kStripes>
struct RightPlaces {
  const uint8_t* at[kStripes];

  VS_INLINE RightPlaces(const Plan& plan, const uint8_t* row, int x) {
    const int first = plan.width - 1 - x + plan.min_disparity + plan.cell;
    for (int r = 0; r < kStripes; ++r) {
      // Too far away to be looked at; any place inside will do.
      const auto place = static_cast<unsigned>(Clamp(first + r, 0, plan.width + 2 * plan.cell));
      at[r] = row + (place % kStripes) * plan.right_stride + place / kStripes;
    }
  }
  VS_INLINE void Advance() {
    const uint8_t* last = at[kStripes - 1];
    for (int r = kStripes - 1; r > 0; --r) at[r] = at[r - 1];
    at[0] = last - 1;
  }
};

constexpr int CensusBytesOf(CostKind kind) {
  switch (kind) {
    case CostKind::kCensus3:
    case CostKind::kAdCensus3:
      return 3;
    case CostKind::kCensus6:
    case CostKind::kAdCensus6:
      return 6;
    case CostKind::kCensus8:
    case CostKind::kAdCensus8:
      return 8;
    default:
      return 0;
  }
}
constexpr bool HasAd(CostKind kind) {
  return kind == CostKind::kAdCensus3 || kind == CostKind::kAdCensus6 ||
         kind == CostKind::kAdCensus8;
}

// C(x, i) of pixel_cost.h for one vector of indices. `left` is the left pixel in the first plane,
// `right` its counterparts there.
template <CostKind kKind>
VS_INLINE V PixelCost(const Plan& plan, const uint8_t* left, const uint8_t* right,
                      size_t right_plane) {
  const size_t left_plane = static_cast<size_t>(plan.width);
  const V limit = Simd::Set(plan.limit);
  if constexpr (kKind == CostKind::kSad) {
    return Simd::Min(AbsoluteDifference(Simd::Set(left[0]), Simd::LoadAnywhere(right)), limit);
  } else if constexpr (kKind == CostKind::kBirchfieldTomasi) {
    const V l = Simd::Set(left[0]);
    const V l_low = Simd::Set(left[left_plane]);
    const V l_high = Simd::Set(left[2 * left_plane]);
    const V r = Simd::LoadAnywhere(right);
    const V r_low = Simd::LoadAnywhere(right + right_plane);
    const V r_high = Simd::LoadAnywhere(right + 2 * right_plane);
    const V a = Simd::Max(Simd::SubtractSaturated(l, r_high), Simd::SubtractSaturated(r_low, l));
    const V b = Simd::Max(Simd::SubtractSaturated(r, l_high), Simd::SubtractSaturated(l_low, r));
    return Simd::Min(Simd::Min(a, b), limit);
  } else {
    constexpr int kBytes = CensusBytesOf(kKind);
    V cost = Simd::BitCount(Simd::Xor(Simd::Set(left[0]), Simd::LoadAnywhere(right)));
    for (int b = 1; b < kBytes; ++b) {
      const V code = Simd::Set(left[b * left_plane]);
      cost = Simd::Add(
          cost, Simd::BitCount(Simd::Xor(code, Simd::LoadAnywhere(right + b * right_plane))));
    }
    if constexpr (kBytes > 3) cost = Simd::Average(cost, Simd::Set(0));
    if constexpr (HasAd(kKind)) {
      const V grey = Simd::LoadAnywhere(right + kBytes * right_plane);
      const V step = AbsoluteDifference(Simd::Set(left[kBytes * left_plane]), grey);
      cost = Simd::Add(cost, Simd::Min(step, limit));
    }
    return cost;
  }
}

// The costs of one row of pixels, before any window or smoothing, from left to right.
template <int kStripes, CostKind kKind>
class RawCosts {
 public:
  RawCosts(const Plan& plan, const Layout<kStripes>& layout, int y)
      : plan_(plan),
        layout_(layout),
        left_(plan.left_features + static_cast<size_t>(y) * plan.planes * plan.width),
        right_(plan.right_features +
               static_cast<size_t>(y) * plan.planes * kStripes * plan.right_stride),
        places_(plan, right_, 0) {}

  // The cell of column x; afterwards that of x + 1 can be had.
  VS_INLINE void Compute(int x, uint8_t* out) {
    if (x != next_) places_ = RightPlaces<kStripes>(plan_, right_, x);
    next_ = x + 1;
    Cell<kStripes> cost = layout_.outside;
    if (AnyInside(x)) {
      const size_t right_plane = kStripes * plan_.right_stride;
      for (int r = 0; r < kStripes; ++r) {
        const V pixel = PixelCost<kKind>(plan_, left_ + x, places_.at[r], right_plane);
        cost.v[r] = Simd::Max(pixel, layout_.least.v[r]);
      }
      SetOutside(plan_, layout_, x, &cost);
    }
    cost.Store(out);
    // Beyond the right view there is nothing to advance to.
    if (AnyInside(x)) {
      places_.Advance();
    } else {
      next_ = -1;
    }
  }

 private:
  // Whether any counterpart of left pixel x is inside.
  VS_INLINE bool AnyInside(int x) const {
    return static_cast<unsigned>(x - plan_.min_disparity) <
           static_cast<unsigned>(plan_.width + plan_.num_disparities - 1);
  }

  const Plan plan_;
  const Layout<kStripes>& layout_;
  const uint8_t* left_;
  const uint8_t* right_;
  RightPlaces<kStripes> places_;
  int next_ = 0;
};

template <int kStripes>
VS_INLINE void SmoothAlong(const uint8_t* before, const uint8_t* centre, const uint8_t* after,
                           uint8_t* out) {
  for (int r = 0; r < kStripes; ++r) {
    const V c = Simd::Load(centre + r * kLanes);
    const V sides = Simd::Average(Simd::Load(before + r * kLanes), Simd::Load(after + r * kLanes));
    Simd::Store(out + r * kLanes, Simd::Average(c, sides));
  }
}

// Makes a row of costs; compute(x, cell) gives them before smoothing.
template <int kStripes, class Work, class Compute>
VS_INLINE void MakeCostRow(const Plan& plan, const Work& work, Compute compute) {
  constexpr int kCell = kStripes * kLanes;
  if (plan.gate < 0) {
    for (int x = work.begin; x < work.end; ++x) {
      compute(x, work.row + static_cast<size_t>(x) * kCell);
    }
    return;
  }
  // Three cells are looked at, a fourth is being made.
  const auto raw = [&](int x) {
    uint8_t* slot = work.scratch + static_cast<size_t>(x & 3) * kCell;
    compute(x, slot);
    return slot;
  };
  const uint8_t* grey = plan.guide + static_cast<size_t>(work.y) * plan.guide_stride;
  const uint8_t* before = raw(work.begin > 0 ? work.begin - 1 : work.begin);
  const uint8_t* centre = raw(work.begin);
  for (int x = work.begin; x < work.end; ++x) {
    const uint8_t* after = x + 1 < plan.width ? raw(x + 1) : centre;
    const bool like_before = x > 0 && Distance(grey[x], grey[x - 1]) <= plan.gate;
    const bool like_after = x + 1 < plan.width && Distance(grey[x], grey[x + 1]) <= plan.gate;
    SmoothAlong<kStripes>(like_before ? before : centre, centre, like_after ? after : centre,
                          work.row + static_cast<size_t>(x) * kCell);
    before = centre;
    centre = after;
  }
}

// The window's mean, rounded to the nearest.
template <int kStripes>
void AverageWindow(const Plan& plan, const Layout<kStripes>& layout, int x,
                   const uint16_t* const* sums, uint8_t* out) {
  constexpr int kCell = kStripes * kLanes;
  alignas(64) uint16_t total[kCell] = {};
  for (int k = 0; k < plan.window_height; ++k) {
    const uint16_t* row = sums[k] + static_cast<size_t>(x) * kCell;
    for (int i = 0; i < kCell; ++i) total[i] = static_cast<uint16_t>(total[i] + row[i]);
  }
  const auto divisor = static_cast<uint32_t>(plan.window_width * plan.window_height);
  // Exact, see DivideRounded in cost_window.cc.
  const int shift = 16 + 31 - __builtin_clz(divisor);
  const uint32_t reciprocal = ((1U << shift) + divisor - 1) / divisor;
  const uint32_t half = divisor / 2;
  for (int i = 0; i < kCell; ++i) {
    // Beyond the range the sum is too great for this; what comes out is overwritten.
    const uint32_t sum = total[i] < (1U << 14) ? total[i] : 0;
    out[i] = static_cast<uint8_t>(((sum + half) * reciprocal) >> shift);
  }
  Cell<kStripes> mean;
  mean.Load(out);
  for (int r = 0; r < kStripes; ++r) {
    mean.v[r] = Simd::Max(mean.v[r], layout.least.v[r]);
  }
  SetOutside(plan, layout, x, &mean);
  mean.Store(out);
}

template <int kStripes>
void ComputeWindowSums(const Plan& plan, const WindowSums& work) {
  constexpr int kCell = kStripes * kLanes;
  const int reach = plan.window_width / 2;
  const auto column = [&](int x) {
    return work.costs + static_cast<size_t>(Clamp(x, 0, plan.width - 1)) * kCell;
  };
  alignas(64) uint16_t total[kCell] = {};
  for (int k = 0; k < plan.window_width; ++k) {
    const uint8_t* added = column(work.begin - reach + k);
    for (int i = 0; i < kCell; ++i) total[i] = static_cast<uint16_t>(total[i] + added[i]);
  }
  for (int x = work.begin; x < work.end; ++x) {
    uint16_t* out = work.sums + static_cast<size_t>(x) * kCell;
    const uint8_t* removed = column(x - reach);
    const uint8_t* added = column(x - reach + plan.window_width);
    for (int i = 0; i < kCell; ++i) {
      out[i] = total[i];
      total[i] = static_cast<uint16_t>(total[i] + added[i] - removed[i]);
    }
  }
}

template <int kStripes>
void ComputeWindowRow(const Plan& shared_plan, const WindowRow& shared_work) {
  const Plan plan = shared_plan;  // see SweepPixels
  const WindowRow work = shared_work;
  const Layout<kStripes> layout(plan);
  MakeCostRow<kStripes>(plan, work, [&](int x, uint8_t* out) {
    AverageWindow<kStripes>(plan, layout, x, work.sums, out);
  });
}

template <int kStripes, CostKind kKind>
void ComputeCostRow(const Plan& shared_plan, const CostRow& shared_work) {
  const Plan plan = shared_plan;  // see SweepPixels
  const CostRow work = shared_work;
  const Layout<kStripes> layout(plan);
  RawCosts<kStripes, kKind> raw(plan, layout, work.y);
  MakeCostRow<kStripes>(plan, work, [&](int x, uint8_t* out) { raw.Compute(x, out); });
}

// One step of a path: L of the pixel before becomes L of this one (path_cost.h).
template <int kStripes>
VS_INLINE void Step(const Cell<kStripes>& cost, V p1, V p2, Cell<kStripes>* path) {
  const V below = Simd::FromBelow(path->v[kStripes - 1], kGuard);
  const V above = Simd::FromAbove(path->v[0], kGuard);
  Cell<kStripes> total;
  for (int r = 0; r < kStripes; ++r) {
    const V lower = r > 0 ? path->v[r - 1] : below;
    const V upper = r < kStripes - 1 ? path->v[r + 1] : above;
    const V near = Simd::Add(Simd::Min(lower, upper), p1);
    total.v[r] = Simd::Add(cost.v[r], Simd::Min(Simd::Min(near, path->v[r]), p2));
  }
  V least = total.v[0];
  for (int r = 1; r < kStripes; ++r) least = Simd::Min(least, total.v[r]);
  least = Simd::LeastOfAll(least);
  for (int r = 0; r < kStripes; ++r) path->v[r] = Simd::Subtract(total.v[r], least);
}

template <int kStripes>
VS_INLINE void StepInMemory(const Cell<kStripes>& cost, V p1, V p2, uint8_t* path,
                            Cell<kStripes>* sum) {
  Cell<kStripes> cell;
  cell.Load(path);
  Step(cost, p1, p2, &cell);
  cell.Store(path);
  for (int r = 0; r < kStripes; ++r) sum->v[r] = Simd::AddSaturated(sum->v[r], cell.v[r]);
}

// By winner and stripe: the lane of the one among the winner and its two neighbours that lies in
// this stripe; kNoLane if none does. Of at least three stripes each holds at most one.
constexpr uint8_t kNoLane = 255;
template <int kStripes>
struct NeighbourLanes {
  uint8_t of[256][kStripes] = {};

  constexpr NeighbourLanes() {
    for (int winner = 0; winner < 256; ++winner) {
      for (int r = 0; r < kStripes; ++r) of[winner][r] = kNoLane;
      for (int i = winner - 1; i <= winner + 1; ++i) {
        if (i >= 0) of[winner][i % kStripes] = static_cast<uint8_t>(i / kStripes);
      }
    }
  }
};

// The least sum of those that are more than one index away from the winner, in all lanes together.
template <int kStripes>
VS_INLINE V LeastButNeighbours(const Layout<kStripes>& layout, int winner,
                               const Cell<kStripes>& sum) {
  V least = Simd::Set(255);
  if constexpr (kStripes >= 3) {
    static constexpr NeighbourLanes<kStripes> kLanesOf;
    for (int r = 0; r < kStripes; ++r) {
      least = Simd::MinBut(least, sum.v[r], kLanesOf.of[winner][r]);
    }
  } else {
    for (int r = 0; r < kStripes; ++r) {
      const V step = AbsoluteDifference(layout.index.v[r], Simd::Set(static_cast<uint8_t>(winner)));
      least = Simd::Min(least, Simd::IfLess(Simd::Set(1), step, sum.v[r], Simd::Set(255)));
    }
  }
  return least;
}

// Selects the left winner of pixel x (selection.h).
template <int kStripes>
VS_INLINE void SelectLeft(const Plan& plan, const SweepRow& work, const Layout<kStripes>& layout,
                          int x, const Cell<kStripes>& sum) {
  // The least sum together with its index, and so the least index among equals.
  V least = Simd::PairLow(sum.v[0], layout.index.v[0]);
  for (int r = 0; r < kStripes; ++r) {
    if (r > 0) least = Simd::MinPairs(least, Simd::PairLow(sum.v[r], layout.index.v[r]));
    least = Simd::MinPairs(least, Simd::PairHigh(sum.v[r], layout.index.v[r]));
  }
  const int pair = Simd::LeastPair(least);
  const int index = pair & 0xff;
  const V second = LeastButNeighbours(layout, index, sum);
  alignas(64) uint8_t sums[kStripes * kLanes];
  sum.Store(sums);
  const auto at = [&](int i) {
    const auto place = static_cast<unsigned>(i);
    return sums[(place % kStripes) * kLanes + place / kStripes];
  };
  const int last = plan.num_disparities - 1;
  work.winners.index[x] = static_cast<uint8_t>(index);
  work.winners.best[x] = static_cast<uint8_t>(pair >> 8);
  work.winners.second[x] = Simd::First(Simd::LeastOfAll(second));
  work.winners.before[x] = at(index > 0 ? index - 1 : 0);
  work.winners.after[x] = at(index < last ? index + 1 : last);
}

// The winners of the right view while a row is swept: the least sum and its index of those right
// pixels that are counterparts of the current left pixel, lane by lane like its cell. With the next
// left pixel every right pixel moves on by one index: to the next stripe, or from the last stripe
// to the first one and a lane up (backward: the other way round). One falls out at the end: it has
// been offered everything.
//
// The smaller index wins a tie. Indices rise in a forward sweep, so only a lesser sum is taken;
// they fall in a backward one, so an equal sum is taken too. A sum of 255 never counts; so a
// backward sweep begins with 254.
template <int kStripes>
class RightWinners {
 public:
  // What a block leaves to the next one: two cells at `state`. `row` takes the indices by column.
  VS_INLINE RightWinners(const Plan& plan, const SweepRow& work)
      : plan_(plan), backward_(work.backward), state_(work.right_state), row_(work.right_index) {
    if (state_ == nullptr) return;
    least_.Load(state_);
    index_.Load(state_ + kStripes * kLanes);
  }

  VS_INLINE void Offer(const Layout<kStripes>& layout, int x, const Cell<kStripes>& sum) {
    if (state_ == nullptr) return;
    for (int r = 0; r < kStripes; ++r) {
      const V better = backward_
                           ? Simd::IfLess(least_.v[r], sum.v[r], index_.v[r], layout.index.v[r])
                           : Simd::IfLess(sum.v[r], least_.v[r], layout.index.v[r], index_.v[r]);
      index_.v[r] = better;
      least_.v[r] = Simd::Min(least_.v[r], sum.v[r]);
    }
    // Lane 0 of stripe 0 belongs to this right pixel, the others to those left of it.
    const int right = x - plan_.min_disparity;
    constexpr int kLast = kStripes - 1;
    if (backward_) {
      Put(right, Simd::First(index_.v[0]));
      const V least = Simd::FromAbove(least_.v[0], 254);
      const V index = Simd::FromAbove(index_.v[0], 0);
      for (int r = 0; r < kLast; ++r) {
        least_.v[r] = least_.v[r + 1];
        index_.v[r] = index_.v[r + 1];
      }
      least_.v[kLast] = least;
      index_.v[kLast] = index;
    } else {
      Put(right - (kStripes * kLanes - 1), Simd::Last(index_.v[kLast]));
      const V least = Simd::FromBelow(least_.v[kLast], 255);
      const V index = Simd::FromBelow(index_.v[kLast], 0);
      for (int r = kLast; r > 0; --r) {
        least_.v[r] = least_.v[r - 1];
        index_.v[r] = index_.v[r - 1];
      }
      least_.v[0] = least;
      index_.v[0] = index;
    }
  }

  // At the end of a block: keeps the state, and where the row ends takes what is still held.
  // `next_x` is the column that would have come next.
  VS_INLINE void Finish(int next_x) {
    if (state_ == nullptr) return;
    least_.Store(state_);
    index_.Store(state_ + kStripes * kLanes);
    if (next_x >= 0 && next_x < plan_.width) return;
    const uint8_t* indices = state_ + kStripes * kLanes;
    for (int i = 0; i < kStripes * kLanes; ++i) {
      Put(next_x - plan_.min_disparity - i, indices[(i % kStripes) * kLanes + i / kStripes]);
    }
  }

 private:
  VS_INLINE void Put(int right, uint8_t index) const {
    if (right >= 0 && right < plan_.width) row_[right] = index;
  }

  const Plan& plan_;
  const bool backward_;
  uint8_t* const state_;
  uint8_t* const row_;
  Cell<kStripes> least_;
  Cell<kStripes> index_;
};

template <int kStripes, int kDirections, SweepMode kMode>
void SweepPixels(const Plan& shared_plan, const SweepRow& shared_work) {
  constexpr int kCell = kStripes * kLanes;
  // Copies that nobody else can see: a byte that is stored could be any other memory.
  const Plan plan = shared_plan;
  const SweepRow work = shared_work;
  const Layout<kStripes> layout(plan);
  const V p1 = Simd::Set(plan.p1);
  const uint8_t* grey = plan.guide + static_cast<size_t>(work.y) * plan.guide_stride;
  const uint8_t* grey_above = work.y > 0 ? grey - plan.guide_stride : grey;
  const uint8_t* grey_below = work.y + 1 < plan.height ? grey + plan.guide_stride : grey;
  const int step = work.backward ? -1 : 1;
  const int first = work.backward ? work.end - 1 : work.begin;
  const int k = work.backward ? plan.height - 1 - work.y : work.y;

  RightWinners<kStripes> right(plan, work);
  Cell<kStripes> along;
  along.Load(work.along);
  for (int n = 0, x = first; n < work.end - work.begin; ++n, x += step) {
    const size_t at = static_cast<size_t>(x) * kCell;
    Cell<kStripes> cost;
    cost.Load(work.here + at);
    if (plan.gate >= 0) {
      const bool like_above = Distance(grey[x], grey_above[x]) <= plan.gate;
      const bool like_below = Distance(grey[x], grey_below[x]) <= plan.gate;
      const uint8_t* above = (like_above ? work.above : work.here) + at;
      const uint8_t* below = (like_below ? work.below : work.here) + at;
      for (int r = 0; r < kStripes; ++r) {
        const V sides =
            Simd::Average(Simd::Load(above + r * kLanes), Simd::Load(below + r * kLanes));
        cost.v[r] = Simd::Average(cost.v[r], sides);
      }
      SetOutside(plan, layout, x, &cost);
    }
    Step(cost, p1, Simd::Set(work.p2[0][x]), &along);
    Cell<kStripes> sum = along;
    if constexpr (kDirections >= 2) {
      StepInMemory(cost, p1, Simd::Set(work.p2[1][x]), work.across + at, &sum);
    }
    const int i = work.backward ? plan.width - 1 - x : x;
    if constexpr (kDirections >= 3) {
      const size_t line = static_cast<size_t>(plan.height - 1 + i - k) * kCell;
      StepInMemory(cost, p1, Simd::Set(work.p2[2][x]), work.diagonal[0] + line, &sum);
    }
    if constexpr (kDirections >= 4) {
      const size_t line = static_cast<size_t>(i + k) * kCell;
      StepInMemory(cost, p1, Simd::Set(work.p2[3][x]), work.diagonal[1] + line, &sum);
    }
    if constexpr (kMode == SweepMode::kStore) {
      for (int r = 0; r < kStripes; ++r) Simd::Stream(work.sums + at + r * kLanes, sum.v[r]);
    } else {
      if constexpr (kMode == SweepMode::kFinish) {
        for (int r = 0; r < kStripes; ++r) {
          sum.v[r] = Simd::AddSaturated(sum.v[r], Simd::Load(work.sums + at + r * kLanes));
        }
      }
      for (int r = 0; r < kStripes; ++r) sum.v[r] = Simd::Or(sum.v[r], layout.beyond.v[r]);
      SelectLeft(plan, work, layout, x, sum);
      right.Offer(layout, x, sum);
    }
  }
  along.Store(work.along);
  if constexpr (kMode != SweepMode::kStore) right.Finish(work.backward ? work.begin - 1 : work.end);
  if constexpr (kMode == SweepMode::kStore) Simd::EndStream();
}

// The functions for one number of stripes.
using CostFunction = void (*)(const Plan&, const CostRow&);
using SweepFunction = void (*)(const Plan&, const SweepRow&);
struct StripeKernels {
  CostFunction cost[vs::cpu::kCostKinds];
  void (*window_sums)(const Plan&, const WindowSums&);
  void (*window_row)(const Plan&, const WindowRow&);
  SweepFunction store[4];
  SweepFunction finish[4];
  SweepFunction only;
};

template <int kStripes>
constexpr StripeKernels MakeStripeKernels() {
  return {
      {&ComputeCostRow<kStripes, CostKind::kCensus3>, &ComputeCostRow<kStripes, CostKind::kCensus6>,
       &ComputeCostRow<kStripes, CostKind::kCensus8>,
       &ComputeCostRow<kStripes, CostKind::kAdCensus3>,
       &ComputeCostRow<kStripes, CostKind::kAdCensus6>,
       &ComputeCostRow<kStripes, CostKind::kAdCensus8>, &ComputeCostRow<kStripes, CostKind::kSad>,
       &ComputeCostRow<kStripes, CostKind::kBirchfieldTomasi>},
      &ComputeWindowSums<kStripes>,
      &ComputeWindowRow<kStripes>,
      {&SweepPixels<kStripes, 1, SweepMode::kStore>, &SweepPixels<kStripes, 2, SweepMode::kStore>,
       &SweepPixels<kStripes, 3, SweepMode::kStore>, &SweepPixels<kStripes, 4, SweepMode::kStore>},
      {&SweepPixels<kStripes, 1, SweepMode::kFinish>, &SweepPixels<kStripes, 2, SweepMode::kFinish>,
       &SweepPixels<kStripes, 3, SweepMode::kFinish>,
       &SweepPixels<kStripes, 4, SweepMode::kFinish>},
      &SweepPixels<kStripes, 1, SweepMode::kOnly>};
}

// The kernels for the numbers of stripes that an instruction set is compiled for, rising.
template <int... kStripes>
struct KernelSet {
  static int Stripes(int num_disparities) {
    constexpr int kCounts[] = {kStripes...};
    for (const int stripes : kCounts) {
      if (stripes * kLanes >= num_disparities) return stripes;
    }
    return 0;
  }
  static const StripeKernels& Of(int stripes) {
    static constexpr int kCounts[] = {kStripes...};
    static constexpr StripeKernels kTables[] = {MakeStripeKernels<kStripes>()...};
    int k = 0;
    while (kCounts[k] != stripes) ++k;
    return kTables[k];
  }
  static void Cost(const Plan& plan, CostKind kind, const CostRow& work) {
    Of(plan.stripes).cost[static_cast<int>(kind)](plan, work);
  }
  static void Sums(const Plan& plan, const WindowSums& work) {
    Of(plan.stripes).window_sums(plan, work);
  }
  static void Window(const Plan& plan, const WindowRow& work) {
    Of(plan.stripes).window_row(plan, work);
  }
  static void Sweep(const Plan& plan, int directions, SweepMode mode, const SweepRow& work) {
    const StripeKernels& kernels = Of(plan.stripes);
    if (mode == SweepMode::kOnly) return kernels.only(plan, work);
    (mode == SweepMode::kStore ? kernels.store : kernels.finish)[directions - 1](plan, work);
  }
  static constexpr Kernels Make(const char* name) {
    return {name,  kLanes, &Stripes, &MakeLayout, &ComputeCensusRow, &ComputePenaltyRow,
            &Cost, &Sums,  &Window,  &Sweep,      &kFilterKernels};
  }
};

}  // namespace
// NOLINTEND(misc-definitions-in-headers)

#undef VS_INLINE
