// From pictures to rows of costs: census codes, penalties, costs, windows. Part of kernels_of.h;
// see there.
#pragma once

#include "engine/stereo/cpu/cells_of.h"

// NOLINTBEGIN(misc-definitions-in-headers): each file that includes this shall have its own.
// NOLINTBEGIN(bugprone-implicit-widening-of-multiplication-result): places within a cell.
namespace {

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

// Place u + cell of the mirrored row, where u = width - 1 - x, is stripe u % kStripes of column
// u / kStripes + kLanes.
template <int kStripes>
void StripeRow(const Plan& plan, const uint8_t* row, uint8_t* striped) {
  uint8_t* const out = striped + kLanes;
  const size_t stride = plan.right_stride;
  const uint8_t* const last = row + plan.width - 1;
  const int columns = plan.width / kStripes;
  int u = 0;
  if (columns >= kLanes) {
    for (int k = 0; k < columns; k += kLanes) {
      // The last piece ends with the row.
      const int from = k + kLanes <= columns ? k : columns - kLanes;
#pragma GCC unroll 16
      for (int r = 0; r < kStripes; ++r) {
        Simd::StoreAnywhere(out + r * stride + from,
                            Simd::EveryNth<kStripes>(last - from * kStripes - r));
      }
    }
    u = columns * kStripes;
  }
  for (; u < plan.width; ++u) out[u % kStripes * stride + u / kStripes] = last[-u];
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

inline void ComputeLikenessRow(int gate, const uint8_t* grey, const uint8_t* from, int count,
                               uint8_t* like) {
  const V most = Simd::Set(static_cast<uint8_t>(gate));
  for (int x = 0; x < count; x += kLanes) {
    const V step = AbsoluteDifference(Simd::LoadAnywhere(grey + x), Simd::LoadAnywhere(from + x));
    Simd::StoreAnywhere(like + x, Simd::IfLess(most, step, Simd::Set(0), Simd::Set(255)));
  }
}

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

constexpr int PlanesOf(CostKind kind) {
  if (kind == CostKind::kSad) return 1;
  if (kind == CostKind::kBirchfieldTomasi) return 3;
  return CensusBytesOf(kind) + (HasAd(kind) ? 1 : 0);
}

// An array needs a place.
constexpr int PlanesIf(bool held, int planes) { return held ? planes : 1; }

// The features of a left pixel's counterparts. One pixel farther every place in the mirrored row is
// one less, so that a stripe finds what the stripe before it had, and only the first one anything
// new. So the features stay in registers where there are enough of these.
template <int kStripes, int kPlanes>
class Counterparts {
 public:
  // `row` is the row of the right view, x the left pixel.
  VS_INLINE Counterparts(const Plan& plan, const uint8_t* row, int x)
      : plane_size_(kStripes * plan.right_stride) {
    const int first = plan.width - 1 - x + plan.min_disparity + plan.cell;
#pragma GCC unroll 16
    for (int r = 0; r < kStripes; ++r) {
      // Too far away to be looked at; any place inside will do.
      const auto place = static_cast<unsigned>(Clamp(first + r, 0, plan.width + 2 * plan.cell));
      at_[r] = row + (place % kStripes) * plan.right_stride + place / kStripes;
      if constexpr (kHeld) {
#pragma GCC unroll 16
        for (int p = 0; p < kPlanes; ++p) held_[p].v[r] = Read(p, r);
      }
    }
  }
  VS_INLINE void Advance() {
    const uint8_t* last = at_[kStripes - 1];
#pragma GCC unroll 16
    for (int r = kStripes - 1; r > 0; --r) at_[r] = at_[r - 1];
    at_[0] = last - 1;
    if constexpr (kHeld) {
#pragma GCC unroll 16
      for (int p = 0; p < kPlanes; ++p) {
#pragma GCC unroll 16
        for (int r = kStripes - 1; r > 0; --r) held_[p].v[r] = held_[p].v[r - 1];
        held_[p].v[0] = Read(p, 0);
      }
    }
  }
  VS_INLINE V Feature(int plane, int stripe) const {
    if constexpr (kHeld) {
      return held_[plane].v[stripe];
    } else {
      return Read(plane, stripe);
    }
  }

 private:
  static constexpr bool kHeld = kStripes * kPlanes <= Simd::kRegisters / 2;

  VS_INLINE V Read(int plane, int stripe) const {
    return Simd::LoadAnywhere(at_[stripe] + static_cast<size_t>(plane) * plane_size_);
  }

  size_t plane_size_;
  const uint8_t* at_[kStripes];  // the first plane's features, by stripe
  Cell<kStripes> held_[PlanesIf(kHeld, kPlanes)];
};

// C(x, i) of pixel_cost.h for one stripe of indices. `left` is the left pixel in the first plane.
template <CostKind kKind, int kStripes>
VS_INLINE V PixelCost(const Plan& plan, const uint8_t* left,
                      const Counterparts<kStripes, PlanesOf(kKind)>& right, int stripe) {
  const size_t left_plane = static_cast<size_t>(plan.width);
  const V limit = Simd::Set(plan.limit);
  if constexpr (kKind == CostKind::kSad) {
    return Simd::Min(AbsoluteDifference(Simd::Set(left[0]), right.Feature(0, stripe)), limit);
  } else if constexpr (kKind == CostKind::kBirchfieldTomasi) {
    const V l = Simd::Set(left[0]);
    const V l_low = Simd::Set(left[left_plane]);
    const V l_high = Simd::Set(left[2 * left_plane]);
    const V r = right.Feature(0, stripe);
    const V r_low = right.Feature(1, stripe);
    const V r_high = right.Feature(2, stripe);
    const V a = Simd::Max(Simd::SubtractSaturated(l, r_high), Simd::SubtractSaturated(r_low, l));
    const V b = Simd::Max(Simd::SubtractSaturated(r, l_high), Simd::SubtractSaturated(l_low, r));
    return Simd::Min(Simd::Min(a, b), limit);
  } else {
    constexpr int kBytes = CensusBytesOf(kKind);
    const auto different = [&](int b) __attribute__((always_inline)) {
      return Simd::Xor(Simd::Set(left[b * left_plane]), right.Feature(b, stripe));
    };
    V cost = Simd::BitCountOfThree(different(0), different(1), different(2));
    for (int b = 3; b < kBytes; ++b) cost = Simd::Add(cost, Simd::BitCount(different(b)));
    if constexpr (kBytes > 3) cost = Simd::Average(cost, Simd::Set(0));
    if constexpr (HasAd(kKind)) {
      const V grey = right.Feature(kBytes, stripe);
      // Coarse grey is at most 64, so that the difference has a sign.
      const V step = Simd::Magnitude(Simd::Subtract(Simd::Set(left[kBytes * left_plane]), grey));
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
        counterparts_(plan, right_, 0) {}

  // The cell of column x; afterwards that of x + 1 can be had.
  VS_INLINE void Compute(int x, Cell<kStripes>* cost) {
    if (!AnyInside(x)) {
      *cost = layout_.outside;
      next_ = -1;
      return;
    }
    if (x != next_) counterparts_ = Counterparts<kStripes, PlanesOf(kKind)>(plan_, right_, x);
    for (int r = 0; r < kStripes; ++r) {
      cost->v[r] = PixelCost<kKind>(plan_, left_ + x, counterparts_, r);
      if (!layout_.full) cost->v[r] = Simd::Max(cost->v[r], layout_.least.v[r]);
    }
    SetOutside(plan_, layout_, x, cost);
    counterparts_.Advance();
    next_ = x + 1;
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
  Counterparts<kStripes, PlanesOf(kKind)> counterparts_;
  int next_ = 0;
};

// `yes` if the mask is 0xff, `no` if it is 0; without a branch that nobody could predict.
VS_INLINE const uint8_t* Either(uint8_t mask, const uint8_t* yes, const uint8_t* no) {
  return no + (static_cast<int8_t>(mask) & (yes - no));
}

// The mean of a cell and its neighbours before and after, which stop at an edge.
template <int kStripes>
VS_INLINE void SmoothAlong(const uint8_t* before, uint8_t like_before, const uint8_t* centre,
                           const uint8_t* after, uint8_t like_after, uint8_t* out) {
  before = Either(like_before, before, centre);
  after = Either(like_after, after, centre);
  for (int r = 0; r < kStripes; ++r) {
    const int at = r * kLanes;
    const V sides = Simd::Average(Simd::Load(before + at), Simd::Load(after + at));
    Simd::Store(out + at, Simd::Average(Simd::Load(centre + at), sides));
  }
}

// Makes a row of costs; compute(x, cell) gives them before smoothing.
template <int kStripes, class Work, class Compute>
VS_INLINE void MakeCostRow(const Plan& plan, const Work& work, Compute compute) {
  constexpr int kCell = kStripes * kLanes;
  const auto out = [&](int x) { return work.row + static_cast<size_t>(x) * kCell; };
  if (plan.gate < 0) {
    for (int x = work.begin; x < work.end; ++x) compute(x, out(x));
    return;
  }
  alignas(64) uint8_t cells[3][kCell] = {};
  uint8_t* before = cells[0];
  uint8_t* centre = cells[1];
  uint8_t* after = cells[2];
  const int end = work.end < plan.width ? work.end + 1 : plan.width;
  for (int x = work.begin > 0 ? work.begin - 1 : 0; x < end; ++x) {
    uint8_t* const oldest = before;
    before = centre;
    centre = after;
    after = oldest;
    compute(x, after);
    if (x > work.begin) {
      SmoothAlong<kStripes>(before, work.like_before[x - 1], centre, after, work.like_before[x],
                            out(x - 1));
    }
  }
  if (work.end == plan.width) {
    SmoothAlong<kStripes>(centre, work.like_before[end - 1], after, after, 0, out(end - 1));
  }
}

// The window's mean, rounded to the nearest.
template <int kStripes>
void AverageWindow(const Plan& plan, const Layout<kStripes>& layout, int x,
                   const uint16_t* const* sums, Cell<kStripes>* mean) {
  constexpr int kCell = kStripes * kLanes;
  alignas(64) uint8_t out[kCell];
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
  mean->Load(out);
  for (int r = 0; r < kStripes; ++r) mean->v[r] = Simd::Max(mean->v[r], layout.least.v[r]);
  SetOutside(plan, layout, x, mean);
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
    Cell<kStripes> mean;
    AverageWindow<kStripes>(plan, layout, x, work.sums, &mean);
    mean.Store(out);
  });
}

template <int kStripes, CostKind kKind>
void ComputeCostRow(const Plan& shared_plan, const CostRow& shared_work) {
  const Plan plan = shared_plan;  // see SweepPixels
  const CostRow work = shared_work;
  const Layout<kStripes> layout(plan);
  RawCosts<kStripes, kKind> raw(plan, layout, work.y);
  // Inlined, so that its state stays in registers.
  MakeCostRow<kStripes>(
      plan, work, [&](int x, uint8_t* out) __attribute__((always_inline)) {
        Cell<kStripes> cell;
        raw.Compute(x, &cell);
        cell.Store(out);
      });
}

}  // namespace
// NOLINTEND(bugprone-implicit-widening-of-multiplication-result)
// NOLINTEND(misc-definitions-in-headers)
