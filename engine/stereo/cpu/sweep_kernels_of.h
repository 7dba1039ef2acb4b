// From costs to winners: paths, their sums, and the least sum of each pixel in both views. Part of
// kernels_of.h; see there.
#pragma once

#include "engine/stereo/cpu/cells_of.h"

// NOLINTBEGIN(misc-definitions-in-headers): each file that includes this shall have its own.
// NOLINTBEGIN(bugprone-implicit-widening-of-multiplication-result): places within a cell.
namespace {

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

// `sum` is what the directions before have added up.
template <int kStripes>
VS_INLINE void StepInMemory(const Cell<kStripes>& cost, V p1, V p2, uint8_t* path,
                            Cell<kStripes>* sum) {
  Cell<kStripes> cell;
  cell.Load(path);
  Step(cost, p1, p2, &cell);
  cell.Store(path);
  for (int r = 0; r < kStripes; ++r) sum->v[r] = Simd::AddSaturated(sum->v[r], cell.v[r]);
}

// Of at least three stripes each holds at most one of three indices in a row: by winner and stripe,
// the lane of the one among the winner and its two neighbours that lies in this stripe.
template <int kStripes>
struct NeighbourLanes {
  Simd::Exception of[256][kStripes] = {};

  constexpr NeighbourLanes() {
    for (int winner = 0; winner < 256; ++winner) {
      for (int r = 0; r < kStripes; ++r) of[winner][r] = Simd::kNoException;
      for (int i = winner - 1; i <= winner + 1; ++i) {
        if (i >= 0 && i < kStripes * kLanes) of[winner][i % kStripes] = Simd::Except(i / kStripes);
      }
    }
  }
};

// Where an index lies in a cell, from index -1 to the one after the last; these two lie anywhere.
template <int kStripes>
struct Places {
  uint8_t of[kStripes * kLanes + 2] = {};

  constexpr Places() {
    for (int i = 0; i < kStripes * kLanes; ++i) {
      of[i + 1] = static_cast<uint8_t>(i % kStripes * kLanes + i / kStripes);
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

struct Winner {
  int index;
  int sum;
};

// The least sum together with its index, and so the least index among equals.
template <int kStripes>
VS_INLINE Winner FindWinner(const Layout<kStripes>& layout, const Cell<kStripes>& sum) {
  // First lane by lane.
  V least = sum.v[0];
  V least_index = layout.index.v[0];
  for (int r = 1; r < kStripes; ++r) {
    Simd::TakeLess(sum.v[r], layout.index.v[r], &least, &least_index);
  }
  const int pair = Simd::LeastPair(
      Simd::MinPairs(Simd::PairLow(least, least_index), Simd::PairHigh(least, least_index)));
  return {pair & 0xff, pair >> 8};
}

// The same where the least sum is known to be 0: the first lane that has one, and its first stripe.
template <int kStripes>
VS_INLINE Winner FindZero(const Cell<kStripes>& sum) {
  uint64_t zeros[kStripes];
  uint64_t any = 0;
#pragma GCC unroll 16
  for (int r = 0; r < kStripes; ++r) any |= zeros[r] = Simd::ZeroLanes(sum.v[r]);
  const int lane = __builtin_ctzll(any);
  int stripe = kStripes - 1;
#pragma GCC unroll 16
  for (int r = kStripes - 2; r >= 0; --r) stripe = (zeros[r] >> lane & 1) != 0 ? r : stripe;
  return {lane * kStripes + stripe, 0};
}

// Notes the left winner of pixel x (selection.h).
template <int kStripes>
VS_INLINE void NoteLeft(const SweepRow& work, const Layout<kStripes>& layout, int x,
                        const Cell<kStripes>& sum, Winner winner) {
  const int index = winner.index;
  const V second = LeastButNeighbours(layout, index, sum);
  alignas(64) uint8_t sums[kStripes * kLanes];
  sum.Store(sums);
  static constexpr Places<kStripes> kPlaces;
  work.winners.index[x] = static_cast<uint8_t>(index);
  work.winners.best[x] = static_cast<uint8_t>(winner.sum);
  work.winners.second[x] = Simd::LeastByte(second);
  work.winners.before[x] = sums[kPlaces.of[index]];
  work.winners.after[x] = sums[kPlaces.of[index + 2]];
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
#pragma GCC unroll 16
    for (int r = 0; r < kStripes; ++r) {
      if (backward_) {
        Simd::TakeLeast(sum.v[r], layout.index.v[r], &least_.v[r], &index_.v[r]);
      } else {
        Simd::TakeLess(sum.v[r], layout.index.v[r], &least_.v[r], &index_.v[r]);
      }
    }
    // Lane 0 of stripe 0 belongs to this right pixel, the others to those left of it.
    const int right = x - plan_.min_disparity;
    constexpr int kLast = kStripes - 1;
    if (backward_) {
      Put(right, Simd::First(index_.v[0]));
      const V least = Simd::FromAbove(least_.v[0], 254);
      const V index = Simd::FromAbove(index_.v[0], 0);
#pragma GCC unroll 16
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
#pragma GCC unroll 16
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

// How many pixels ahead stored sums are fetched.
constexpr int kPrefetch = 10;

template <int kStripes, int kDirections, SweepMode kMode>
void SweepPixels(const Plan& shared_plan, const SweepRow& shared_work) {
  constexpr int kCell = kStripes * kLanes;
  // Copies that nobody else can see: a byte that is stored could be any other memory.
  const Plan plan = shared_plan;
  SweepRow work = shared_work;
  if constexpr (kMode == SweepMode::kOnly) work.backward = false;  // so the compiler knows
  const Layout<kStripes> layout(plan);
  const V p1 = Simd::Set(plan.p1);
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
      const uint8_t* above = Either(work.like_above[x], work.above, work.here) + at;
      const uint8_t* below = Either(work.like_below[x], work.below, work.here) + at;
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
          const uint8_t* stored = work.sums + at + r * kLanes;
          // They come from far away; the processor does not look ahead enough by itself.
          __builtin_prefetch(stored + step * kPrefetch * kCell);
          sum.v[r] = Simd::AddSaturated(sum.v[r], Simd::Load(stored));
        }
      }
      if (!layout.full) {
        for (int r = 0; r < kStripes; ++r) sum.v[r] = Simd::Or(sum.v[r], layout.beyond.v[r]);
      }
      if constexpr (kMode == SweepMode::kOnly) {
        NoteLeft(work, layout, x, sum, FindZero(sum));  // a path's costs: the least is always 0
      } else {
        NoteLeft(work, layout, x, sum, FindWinner(layout, sum));
      }
      right.Offer(layout, x, sum);
    }
  }
  along.Store(work.along);
  if constexpr (kMode != SweepMode::kStore) right.Finish(work.backward ? work.begin - 1 : work.end);
  if constexpr (kMode == SweepMode::kStore) Simd::EndStream();
}

}  // namespace
// NOLINTEND(bugprone-implicit-widening-of-multiplication-result)
// NOLINTEND(misc-definitions-in-headers)
