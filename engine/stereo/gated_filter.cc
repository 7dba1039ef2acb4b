#include "engine/stereo/gated_filter.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>

#include "engine/stereo/selection.h"

namespace vs {
namespace {

constexpr int kMedianRadius = 2;
constexpr int kMedianSize = 2 * kMedianRadius + 1;
constexpr int kMedianCount = kMedianSize * kMedianSize;
constexpr int kFillRadius = 3;
constexpr int kFillCount = (2 * kFillRadius + 1) * (2 * kFillRadius + 1);
constexpr int kLeastMembers = 12;
constexpr int kAgreeing = kDisparityScale;  // 1 px
constexpr uint16_t kAbsent = 0xffff;        // greater than any stored disparity

// Pixels that are filtered at a time, side by side, so that the compiler can use vectors.
constexpr int kLanes = 64;
using Lanes = uint16_t[kLanes];

// Members keep their disparity, the others become kAbsent.
void Gather(const uint16_t* disparity, const uint16_t* grey, const uint16_t* centre, int gate,
            Lanes& __restrict members, Lanes& __restrict count) {
  for (int k = 0; k < kLanes; ++k) {
    const int step = grey[k] - centre[k];
    const uint16_t absent =
        (disparity[k] == kInvalidDisparity) | (step > gate) | (step < -gate) ? kAbsent : 0;
    members[k] = static_cast<uint16_t>(disparity[k] | absent);
    count[k] = static_cast<uint16_t>(count[k] + 1 + absent);  // kAbsent + 1 = 0
  }
}

// The value of rank count / 2 in each lane, found bit by bit from the top: the greatest value that
// at most count / 2 members lie below.
void SelectMedian(const Lanes (&members)[kMedianCount], const Lanes& count, Lanes& median) {
  std::memset(median, 0, sizeof(Lanes));
  for (uint16_t bit = 0x8000; bit != 0; bit = static_cast<uint16_t>(bit >> 1)) {
    Lanes below = {};
    for (const Lanes& value : members) {
      for (int k = 0; k < kLanes; ++k) {
        below[k] = static_cast<uint16_t>(below[k] + (value[k] < (median[k] | bit) ? 1 : 0));
      }
    }
    for (int k = 0; k < kLanes; ++k) {
      median[k] = static_cast<uint16_t>(median[k] | (below[k] <= count[k] / 2 ? bit : 0));
    }
  }
}

// The rows around y, widened, with invalid pixels beyond the border.
class WidenedRows {
 public:
  WidenedRows(int width, std::vector<uint16_t>* memory)
      : width_(width), stride_(static_cast<size_t>(width) + size_t{2} * kMedianRadius + kLanes) {
    memory->assign(2 * stride_ * kMedianSize, kInvalidDisparity);
    disparity_ = memory->data();
    grey_ = disparity_ + stride_ * kMedianSize;
  }

  void Load(const DisparityMap& map, const GreyImage& left, int y) {
    for (int k = 0; k < kMedianSize; ++k) {
      const int from = y + k - kMedianRadius;
      uint16_t* disparity = disparity_ + k * stride_ + kMedianRadius;
      if (from < 0 || from >= map.disparity.height()) {
        std::fill(disparity, disparity + width_, kInvalidDisparity);
        continue;
      }
      std::copy_n(map.disparity.Row(from), width_, disparity);
      std::copy_n(left.Row(from), width_, grey_ + k * stride_ + kMedianRadius);
    }
  }
  // Pixels x + dx, y + dy and to the right of them.
  const uint16_t* Disparity(int x, int dx, int dy) const { return disparity_ + Index(x, dx, dy); }
  const uint16_t* Grey(int x, int dx, int dy) const { return grey_ + Index(x, dx, dy); }

 private:
  size_t Index(int x, int dx, int dy) const {
    return static_cast<size_t>(dy + kMedianRadius) * stride_ +
           static_cast<size_t>(x + dx + kMedianRadius);
  }

  int width_;
  size_t stride_;
  uint16_t* disparity_;
  uint16_t* grey_;
};

void MedianRow(const WidenedRows& rows, int width, int gate, uint16_t* out) {
  Lanes members[kMedianCount];
  Lanes median;
  for (int x = 0; x < width; x += kLanes) {
    Lanes count = {};
    for (int k = 0; k < kMedianCount; ++k) {
      const int dx = k % kMedianSize - kMedianRadius;
      const int dy = k / kMedianSize - kMedianRadius;
      Gather(rows.Disparity(x, dx, dy), rows.Grey(x, dx, dy), rows.Grey(x, 0, 0), gate, members[k],
             count);
    }
    SelectMedian(members, count, median);
    for (int k = 0; k < std::min(kLanes, width - x); ++k) {
      if (out[x + k] != kInvalidDisparity) out[x + k] = median[k];
    }
  }
}

// kInvalidDisparity when the neighbours are too few or disagree.
uint16_t FillValue(const DisparityMap& map, const GreyImage& left, int gate, int x, int y) {
  std::array<uint16_t, kFillCount> members;
  int count = 0;
  const int centre = left.Row(y)[x];
  for (int v = std::max(y - kFillRadius, 0); v <= std::min(y + kFillRadius, left.height() - 1);
       ++v) {
    const uint16_t* disparity = map.disparity.Row(v);
    const uint8_t* grey = left.Row(v);
    for (int u = std::max(x - kFillRadius, 0); u <= std::min(x + kFillRadius, left.width() - 1);
         ++u) {
      if (disparity[u] != kInvalidDisparity && std::abs(grey[u] - centre) <= gate) {
        members[count++] = disparity[u];
      }
    }
  }
  if (count < kLeastMembers) return kInvalidDisparity;
  uint16_t* const begin = members.data();
  std::nth_element(begin, begin + count / 2, begin + count);
  const uint16_t median = begin[count / 2];
  const auto agreeing =
      std::count_if(begin, begin + count, [&](int d) { return std::abs(d - median) <= kAgreeing; });
  return agreeing * 10 >= count * 7 ? median : kInvalidDisparity;
}

}  // namespace

void GatedFilterRows(const DisparityMap& in, const GreyImage& left,
                     const GatedFilterOptions& options, int begin, int end,
                     std::vector<uint16_t>* scratch, DisparityMap* out) {
  const int width = in.disparity.width();
  WidenedRows rows(width, scratch);
  for (int y = begin; y < end; ++y) {
    uint16_t* disparity = out->disparity.Row(y);
    std::copy_n(in.disparity.Row(y), width, disparity);
    std::copy_n(in.confidence.Row(y), width, out->confidence.Row(y));
    std::copy_n(in.reason.Row(y), width, out->reason.Row(y));
    if (options.median) {
      rows.Load(in, left, y);
      MedianRow(rows, width, options.gate, disparity);
    }
    if (!options.fill) continue;
    for (int x = 0; x < width; ++x) {
      if (disparity[x] != kInvalidDisparity) continue;
      disparity[x] = FillValue(in, left, options.gate, x, y);
      if (disparity[x] == kInvalidDisparity) continue;
      out->confidence.Row(y)[x] = kFilledConfidence;
      out->reason.Row(y)[x] = static_cast<uint8_t>(InvalidReason::kNone);
    }
  }
}

}  // namespace vs
