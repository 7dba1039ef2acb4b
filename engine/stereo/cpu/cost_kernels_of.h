// From pictures to rows of costs: census codes, penalties, costs, windows. Part of kernels_of.h;
// see there.
#pragma once

#include "engine/stereo/cpu/cells_of.h"

// NOLINTBEGIN(misc-definitions-in-headers): each file that includes this shall have its own.
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

}  // namespace
// NOLINTEND(misc-definitions-in-headers)
