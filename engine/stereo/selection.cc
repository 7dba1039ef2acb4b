#include "engine/stereo/selection.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <numeric>

#include "engine/stereo/pixel_cost.h"
#include "engine/stereo/quick_division.h"
#include "engine/stereo/sub_pixel.h"

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
int ViewDifference(const SgmSettings& settings, const uint8_t* right_index, int index,
                   int counterpart) {
  int difference = std::abs(right_index[counterpart] - index);
  if (settings.left_right_lenient && counterpart > 0) {
    difference = std::min(difference, std::abs(right_index[counterpart - 1] - index));
  }
  return difference;
}

// Rules 3 to 5.
InvalidReason Judge(const SgmSettings& settings, const GreyImage& left, int x, int y, int index,
                    int best, int second, int difference, int confidence) {
  if (difference > settings.left_right_tolerance) {
    if (index == 0) return InvalidReason::kOutOfRangeFar;
    if (index == settings.num_disparities - 1) return InvalidReason::kOutOfRangeNear;
    return Explain(InvalidReason::kOccluded, left, x, y);
  }
  if (second * (100 - settings.uniqueness_percent) < best * 100) {
    return Explain(InvalidReason::kAmbiguous, left, x, y);
  }
  return confidence < settings.min_confidence ? InvalidReason::kFiltered : InvalidReason::kNone;
}

}  // namespace

int DisparityOffset(const SgmSettings& settings) {
  return settings.min_disparity < 0 ? settings.min_disparity - 1 : 0;
}

void JudgeRow(const SgmSettings& settings, const GreyImage& left, int y, const WinnerRow& winners,
              const uint8_t* right_index, DisparityMap* map) {
  const int width = left.width();
  const int last = settings.num_disparities - 1;
  const int first_stored = kDisparityScale * (settings.min_disparity - DisparityOffset(settings));
  uint16_t* disparity_row = map->disparity.Row(y);
  uint8_t* confidence_row = map->confidence.Row(y);
  uint8_t* reason_row = map->reason.Row(y);
  for (int x = 0; x < width; ++x) {
    const int i = winners.index[x];
    const int best = winners.best[x];
    const int second = winners.second[x];
    int stored = first_stored + kDisparityScale * i;
    if (i > 0 && i < last) {
      stored += SubPixelSixteenths(settings.sub_pixel, winners.before[x], best, winners.after[x]);
    }
    const int counterpart = x - settings.min_disparity - i;
    InvalidReason reason = InvalidReason::kNone;
    int confidence = 0;
    if (counterpart < 0 || counterpart >= width) {
      reason = InvalidReason::kBorder;
    } else if (stored <= 0) {
      reason = InvalidReason::kOutOfRangeFar;
    } else {
      const int difference =
          settings.left_right_check ? ViewDifference(settings, right_index, i, counterpart) : 0;
      const int margin = second == 0 ? 0 : QuickDivide(255 * (second - best), second);
      confidence = std::max<int>(margin >> std::min(difference, 8), kLeastConfidence);
      reason = Judge(settings, left, x, y, i, best, second, difference, confidence);
    }
    const bool valid = reason == InvalidReason::kNone;
    disparity_row[x] = valid ? static_cast<uint16_t>(stored) : kInvalidDisparity;
    confidence_row[x] = valid ? static_cast<uint8_t>(confidence) : 0;
    reason_row[x] = static_cast<uint8_t>(reason);
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
  JudgeRow(settings_, left, y, winners_, right_index_.data(), map);
}

}  // namespace vs
