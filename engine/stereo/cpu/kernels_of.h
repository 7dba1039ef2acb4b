// The kernels of kernels.h over the vector operations of `Simd`. Included by one file for each
// instruction set, after its simd_*.h. Everything is in an unnamed namespace and nothing of the
// standard library is used that could become a function of its own: the linker keeps one copy of
// such a function for the whole program, and it might keep this one.
#pragma once

#include "engine/stereo/cpu/cost_kernels_of.h"
#include "engine/stereo/cpu/kernels.h"
#include "engine/stereo/cpu/sweep_kernels_of.h"
#include "engine/stereo/filter_kernels_of.h"

// NOLINTBEGIN(misc-definitions-in-headers): each file that includes this shall have its own.
namespace {

// The functions for one number of stripes.
using CostFunction = void (*)(const Plan&, const CostRow&);
using SweepFunction = void (*)(const Plan&, const SweepRow&);
struct StripeKernels {
  void (*stripe_row)(const Plan&, const uint8_t*, uint8_t*);
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
      &StripeRow<kStripes>,
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
  static void Stripe(const Plan& plan, const uint8_t* row, uint8_t* striped) {
    Of(plan.stripes).stripe_row(plan, row, striped);
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
    return {name,
            kLanes,
            &Stripes,
            &MakeLayout,
            &ComputeCensusRow,
            &Stripe,
            &ComputePenaltyRow,
            &ComputeLikenessRow,
            &Cost,
            &Sums,
            &Window,
            &Sweep,
            &kFilterKernels};
  }
};

}  // namespace
// NOLINTEND(misc-definitions-in-headers)

#undef VS_INLINE
