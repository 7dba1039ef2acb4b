#include "engine/stereo/gated_filter.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "engine/stereo/selection.h"
#include "engine/stereo/widened_rows.h"

namespace vs {
namespace {

constexpr int kMedianSize = 5;
constexpr int kFillRadius = 3;
constexpr int kFillSize = 2 * kFillRadius + 1;
constexpr int kLeastMembers = 12;
constexpr int kAgreeing = kDisparityScale;  // 1 px

// A row of a fill window, side by side; one lane too many.
using Lanes = uint16_t __attribute__((vector_size(16)));
constexpr Lanes kBeyondWindow = {0, 0, 0, 0, 0, 0, 0, 0xffff};

Lanes LoadLanes(const uint16_t* from) {
  Lanes lanes;
  std::memcpy(&lanes, from, sizeof lanes);
  return lanes;
}

Lanes Lesser(const Lanes& a, const Lanes& b) { return a < b ? a : b; }
Lanes Greater(const Lanes& a, const Lanes& b) { return a > b ? a : b; }

int LeastOf(const Lanes& lanes) {
  uint16_t least = lanes[0];
  for (int k = 1; k < 8; ++k) least = std::min<uint16_t>(least, lanes[k]);
  return least;
}

int GreatestOf(const Lanes& lanes) {
  uint16_t greatest = lanes[0];
  for (int k = 1; k < 8; ++k) greatest = std::max<uint16_t>(greatest, lanes[k]);
  return greatest;
}

int SumOf(const Lanes& lanes) {
  int sum = 0;
  for (int k = 0; k < 8; ++k) sum += lanes[k];
  return sum;
}

// Of the window around pixel x of its middle row; kInvalidDisparity when the members are too few or
// disagree. Not inlined: the loop over all pixels, few of which are holes, needs the registers.
[[gnu::noinline]] uint16_t FillValue(const uint16_t* const* rows, const uint16_t* const* greys,
                                     int gate, int x) {
  Lanes members[kFillSize];  // those that are none become greater than any
  Lanes present = {};
  Lanes low = ~Lanes{};
  Lanes high = {};
  const auto centre = static_cast<uint16_t>(greys[kFillRadius][x] - gate);
  for (int k = 0; k < kFillSize; ++k) {
    const Lanes disparity = LoadLanes(rows[k] + x - kFillRadius);
    const Lanes step = LoadLanes(greys[k] + x - kFillRadius) - centre;
    const auto absent = static_cast<Lanes>((step > static_cast<uint16_t>(2 * gate)) |
                                           (disparity == kInvalidDisparity)) |
                        kBeyondWindow;
    members[k] = disparity | absent;
    low = Lesser(low, members[k]);
    high = Greater(high, disparity & ~absent);
    present += absent + 1;  // absent is 0 or 0xffff
  }
  const int count = SumOf(present);
  if (count < kLeastMembers) return kInvalidDisparity;
  // The greatest value that at most count / 2 members lie below, bit by bit of what it may exceed
  // the least member by.
  const int least_member = LeastOf(low);
  const auto span_of_members = static_cast<unsigned>(GreatestOf(high) - least_member);
  int median = least_member;
  for (int bit = static_cast<int>(std::bit_floor(span_of_members)); bit != 0; bit >>= 1) {
    if (median + bit > 0xffff) continue;
    const auto limit = static_cast<uint16_t>(median + bit);
    Lanes below = {};
    for (const Lanes& row : members) below -= static_cast<Lanes>(row < limit);
    if (SumOf(below) <= count / 2) median = limit;
  }
  Lanes agreeing = {};
  const auto least = static_cast<uint16_t>(std::max(median - kAgreeing, 0));
  const auto span = static_cast<uint16_t>(median + kAgreeing - least);
  for (const Lanes& row : members) agreeing -= static_cast<Lanes>(row - least <= span);
  return SumOf(agreeing) * 10 >= count * 7 ? static_cast<uint16_t>(median) : kInvalidDisparity;
}

// How many valid pixels each fill window of a row has, whatever their grey.
void CountValid(const uint16_t* const* rows, int width, uint16_t* columns, uint16_t* counts) {
  const int end = width + 2 * kFillRadius;
  std::fill(columns, columns + end, uint16_t{0});
  for (int k = 0; k < kFillSize; ++k) {
    const uint16_t* row = rows[k] - kFillRadius;
    for (int x = 0; x < end; ++x) {
      columns[x] = static_cast<uint16_t>(columns[x] + (row[x] != kInvalidDisparity ? 1 : 0));
    }
  }
  for (int x = 0; x < width; ++x) {
    uint16_t count = 0;
    for (int k = 0; k < kFillSize; ++k) count = static_cast<uint16_t>(count + columns[x + k]);
    counts[x] = count;
  }
}

}  // namespace

void GatedFilterRows(const DisparityMap& in, const GreyImage& left,
                     const GatedFilterOptions& options, int begin, int end,
                     GatedFilterScratch* memory, DisparityMap* out, const FilterKernels& kernels) {
  const int width = in.disparity.width();
  const int height = in.disparity.height();
  const auto row_size = static_cast<size_t>(width) + kFillSize;
  memory->rows.resize(row_size * 3);
  uint16_t* const median = memory->rows.data();
  uint16_t* const columns = median + row_size;
  uint16_t* const counts = columns + row_size;
  WidenedRows rows(width, height, kFillSize, WidenedRows::Border::kZero, &memory->disparities);
  WidenedRows greys(width, height, kFillSize, WidenedRows::Border::kZero, &memory->greys);
  const uint16_t* around[kFillSize];
  const uint16_t* greys_around[kFillSize];
  constexpr int kInner = (kFillSize - kMedianSize) / 2;
  for (int y = begin; y < end; ++y) {
    uint16_t* disparity = out->disparity.Row(y);
    std::copy_n(in.disparity.Row(y), width, disparity);
    std::copy_n(in.confidence.Row(y), width, out->confidence.Row(y));
    std::copy_n(in.reason.Row(y), width, out->reason.Row(y));
    rows.Load(
        y, [&](int from) { return in.disparity.Row(from); }, around);
    greys.Load(
        y, [&](int from) { return left.Row(from); }, greys_around);
    if (options.median) {
      kernels.gated_median5(around + kInner, greys_around + kInner, width, options.gate, median);
      for (int x = 0; x < width; ++x) {
        const uint16_t valid = disparity[x] != kInvalidDisparity ? 0xffff : 0;
        disparity[x] = median[x] & valid;  // no branch, so that this vectorises
      }
    }
    if (!options.fill) continue;
    CountValid(around, width, columns, counts);
    for (int x = 0; x < width; ++x) {
      if (disparity[x] != kInvalidDisparity || counts[x] < kLeastMembers) continue;
      disparity[x] = FillValue(around, greys_around, options.gate, x);
      if (disparity[x] == kInvalidDisparity) continue;
      out->confidence.Row(y)[x] = kFilledConfidence;
      out->reason.Row(y)[x] = static_cast<uint8_t>(InvalidReason::kNone);
    }
  }
}

}  // namespace vs
