#include "engine/stereo/selection.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <numeric>

#include "engine/stereo/pixel_cost.h"

namespace vs {
namespace {

constexpr int kSaturatedGrey = 254;
constexpr int kDarkGrey = 3;
constexpr int kTextureRadius = 2;
constexpr int kLeastTexture = 8;

uint8_t LeastOf(const uint8_t* values, int begin, int end) {
  uint8_t least = 255;
  for (int i = begin; i < end; ++i) least = std::min(least, values[i]);
  return least;
}

bool HasTexture(const GreyImage& left, int x, int y) {
  uint8_t low = 255;
  uint8_t high = 0;
  const int begin = std::max(x - kTextureRadius, 0);
  const int end = std::min(x + kTextureRadius + 1, left.width());
  const int bottom = std::min(y + kTextureRadius, left.height() - 1);
  for (int v = std::max(y - kTextureRadius, 0); v <= bottom; ++v) {
    const uint8_t* row = left.Row(v);
    for (int u = begin; u < end; ++u) {
      low = std::min(low, row[u]);
      high = std::max(high, row[u]);
    }
    if (high - low >= kLeastTexture) return true;  // mostly so after one row
  }
  return false;
}

InvalidReason Explain(InvalidReason reason, const GreyImage& left, int x, int y) {
  const int grey = left.Row(y)[x];
  if (grey >= kSaturatedGrey) return InvalidReason::kSaturated;
  if (grey <= kDarkGrey) return InvalidReason::kDark;
  return HasTexture(left, x, y) ? reason : InvalidReason::kLowTexture;
}

// Offers the costs of one left pixel to the right pixels that they belong to.
void OfferToRight(const uint8_t* __restrict sums, const uint8_t* __restrict indices, int count,
                  uint8_t* __restrict least, uint8_t* __restrict index) {
  for (int i = 0; i < count; ++i) {
    const uint8_t sum = sums[i];
    const uint8_t before = least[i];
    const uint8_t better = sum < before ? 0xff : 0;  // a mask, so that this vectorises
    index[i] = static_cast<uint8_t>((indices[i] & better) | (index[i] & ~better));
    least[i] = sum < before ? sum : before;
  }
}

// V for the left pixel with winner `index`; its counterpart is inside.
int ViewDifference(const uint8_t* right_index, int index, int counterpart, bool lenient) {
  const int difference = std::abs(right_index[counterpart] - index);
  const int before = counterpart - static_cast<int>(lenient && counterpart > 0);
  return std::min(difference, std::abs(right_index[before] - index));
}

// Rule 3.
InvalidReason WhyTheViewsDiffer(const GreyImage& left, int x, int y, int index, int last) {
  if (index == 0) return InvalidReason::kOutOfRangeFar;
  if (index == last) return InvalidReason::kOutOfRangeNear;
  return Explain(InvalidReason::kOccluded, left, x, y);
}

}  // namespace

int DisparityOffset(const SgmSettings& settings) {
  return settings.min_disparity < 0 ? settings.min_disparity - 1 : 0;
}

void JudgeRow(const SgmSettings& settings, const GreyImage& left, int y, const WinnerRow& winners,
              const uint8_t* right_index, const FilterKernels& kernels, DisparityMap* map) {
  const int width = left.width();
  uint16_t* disparity = map->disparity.Row(y);
  uint8_t* confidence = map->confidence.Row(y);
  uint8_t* reasons = map->reason.Row(y);
  kernels.measure(
      {.winners = winners,
       .width = width,
       .sub_pixel = settings.sub_pixel,
       .first_stored = kDisparityScale * (settings.min_disparity - DisparityOffset(settings)),
       .last_index = settings.num_disparities - 1,
       .disparity = disparity,
       .confidence = confidence});
  // Copies that no byte that is stored could change.
  const WinnerRow row = winners;
  const int min_disparity = settings.min_disparity;
  const int last = settings.num_disparities - 1;
  const bool check = settings.left_right_check;
  const bool lenient = settings.left_right_lenient;
  const int tolerance = settings.left_right_tolerance;
  const int least_percent = 100 - settings.uniqueness_percent;
  const int min_confidence = settings.min_confidence;
  for (int x = 0; x < width; ++x) {
    const int i = row.index[x];
    const int counterpart = x - min_disparity - i;
    InvalidReason reason = InvalidReason::kNone;
    if (counterpart < 0 || counterpart >= width) {
      reason = InvalidReason::kBorder;
    } else if (disparity[x] == 0) {
      reason = InvalidReason::kOutOfRangeFar;
    } else {
      const int difference = check ? ViewDifference(right_index, i, counterpart, lenient) : 0;
      confidence[x] = std::max(static_cast<uint8_t>(confidence[x] >> std::min(difference, 8)),
                               kLeastConfidence);
      if (difference > tolerance) {
        reason = WhyTheViewsDiffer(left, x, y, i, last);
      } else if (row.second[x] * least_percent < row.best[x] * 100) {
        reason = Explain(InvalidReason::kAmbiguous, left, x, y);
      } else if (confidence[x] < min_confidence) {
        reason = InvalidReason::kFiltered;
      }
    }
    reasons[x] = static_cast<uint8_t>(reason);
    if (reason == InvalidReason::kNone) continue;
    disparity[x] = kInvalidDisparity;
    confidence[x] = 0;
  }
}

void Selection::Prepare(const SgmSettings& settings, int width) {
  settings_ = settings;
  width_ = width;
  indices_.resize(256);
  std::iota(indices_.begin(), indices_.end(), uint8_t{0});
  right_least_.resize(static_cast<size_t>(width));
  right_index_.resize(static_cast<size_t>(width));
  winner_memory_.resize(static_cast<size_t>(width) * WinnerRow::kPlanes);
  winners_ = WinnerRow::In(winner_memory_.data(), width);
}

void Selection::SelectRight(const CellVolume& sums, int y) {
  std::fill(right_least_.begin(), right_least_.end(), uint8_t{255});
  std::fill(right_index_.begin(), right_index_.end(), uint8_t{0});
  for (int x = 0; x < width_; ++x) {
    const InsideRange inside = InsideOf(x, width_, settings_);
    const int mirrored = width_ - 1 - x + settings_.min_disparity + inside.begin;
    OfferToRight(sums.At(x, y) + inside.begin, indices_.data() + inside.begin,
                 inside.end - inside.begin, right_least_.data() + mirrored,
                 right_index_.data() + mirrored);
  }
  std::reverse(right_index_.begin(), right_index_.end());
}

void Selection::SelectLeft(const CellVolume& sums, int y) {
  const int disparities = settings_.num_disparities;
  for (int x = 0; x < width_; ++x) {
    const uint8_t* cell = sums.At(x, y);
    const uint8_t best = LeastOf(cell, 0, disparities);
    const void* first = std::memchr(cell, best, static_cast<size_t>(disparities));
    const int index = static_cast<int>(static_cast<const uint8_t*>(first) - cell);
    winners_.index[x] = static_cast<uint8_t>(index);
    winners_.best[x] = best;
    winners_.second[x] =
        std::min(LeastOf(cell, 0, index - 1), LeastOf(cell, index + 2, disparities));
    winners_.before[x] = cell[std::max(index - 1, 0)];
    winners_.after[x] = cell[std::min(index + 1, disparities - 1)];
  }
}

void Selection::Row(const CellVolume& sums, const GreyImage& left, int y, DisparityMap* map) {
  if (settings_.left_right_check) SelectRight(sums, y);
  SelectLeft(sums, y);
  JudgeRow(settings_, left, y, winners_, right_index_.data(), PlainFilterKernels(), map);
}

}  // namespace vs
