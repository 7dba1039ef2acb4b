#include "engine/stereo/selection.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <numeric>

#include "engine/stereo/pixel_cost.h"
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

int GreySpan(const GreyImage& left, int x, int y) {
  int low = 255;
  int high = 0;
  for (int v = std::max(y - kTextureRadius, 0);
       v <= std::min(y + kTextureRadius, left.height() - 1); ++v) {
    const uint8_t* row = left.Row(v);
    for (int u = std::max(x - kTextureRadius, 0);
         u <= std::min(x + kTextureRadius, left.width() - 1); ++u) {
      low = std::min<int>(low, row[u]);
      high = std::max<int>(high, row[u]);
    }
  }
  return high - low;
}

InvalidReason Explain(InvalidReason reason, const GreyImage& left, int x, int y) {
  const int grey = left.Row(y)[x];
  if (grey >= kSaturatedGrey) return InvalidReason::kSaturated;
  if (grey <= kDarkGrey) return InvalidReason::kDark;
  return GreySpan(left, x, y) < kLeastTexture ? InvalidReason::kLowTexture : reason;
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

}  // namespace

int DisparityOffset(const SgmSettings& settings) {
  return settings.min_disparity < 0 ? settings.min_disparity - 1 : 0;
}

void Selection::Prepare(const SgmSettings& settings, int width) {
  settings_ = settings;
  width_ = width;
  indices_.resize(256);
  std::iota(indices_.begin(), indices_.end(), uint8_t{0});
  right_least_.resize(static_cast<size_t>(width));
  right_index_.resize(static_cast<size_t>(width));
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

Selection::Winner Selection::SelectLeft(const uint8_t* sums) const {
  const int disparities = settings_.num_disparities;
  Winner winner{};
  winner.best = LeastOf(sums, 0, disparities);
  const void* first = std::memchr(sums, winner.best, static_cast<size_t>(disparities));
  winner.index = static_cast<uint8_t>(static_cast<const uint8_t*>(first) - sums);
  winner.second =
      std::min(LeastOf(sums, 0, winner.index - 1), LeastOf(sums, winner.index + 2, disparities));
  return winner;
}

int Selection::Difference(int index, int counterpart) const {
  int difference = std::abs(right_index_[counterpart] - index);
  if (settings_.left_right_lenient && counterpart > 0) {
    difference = std::min(difference, std::abs(right_index_[counterpart - 1] - index));
  }
  return difference;
}

InvalidReason Selection::Judge(const Winner& winner, const GreyImage& left, int x, int y,
                               bool inside, int stored, int difference, int confidence) const {
  if (!inside) return InvalidReason::kBorder;
  if (stored <= 0) return InvalidReason::kOutOfRangeFar;
  if (difference > settings_.left_right_tolerance) {
    if (winner.index == 0) return InvalidReason::kOutOfRangeFar;
    if (winner.index == settings_.num_disparities - 1) return InvalidReason::kOutOfRangeNear;
    return Explain(InvalidReason::kOccluded, left, x, y);
  }
  if (winner.second * (100 - settings_.uniqueness_percent) < winner.best * 100) {
    return Explain(InvalidReason::kAmbiguous, left, x, y);
  }
  return confidence < settings_.min_confidence ? InvalidReason::kFiltered : InvalidReason::kNone;
}

void Selection::Row(const CellVolume& sums, const GreyImage& left, int y, DisparityMap* map) {
  const int last = settings_.num_disparities - 1;
  const int first_stored = kDisparityScale * (settings_.min_disparity - DisparityOffset(settings_));
  if (settings_.left_right_check) SelectRight(sums, y);
  uint16_t* disparity_row = map->disparity.Row(y);
  uint8_t* confidence_row = map->confidence.Row(y);
  uint8_t* reason_row = map->reason.Row(y);
  for (int x = 0; x < width_; ++x) {
    const uint8_t* cell = sums.At(x, y);
    const Winner winner = SelectLeft(cell);
    const int i = winner.index;
    int stored = first_stored + kDisparityScale * i;
    if (i > 0 && i < last) {
      stored += SubPixelSixteenths(settings_.sub_pixel, cell[i - 1], winner.best, cell[i + 1]);
    }
    const int counterpart = x - settings_.min_disparity - i;
    const bool inside = counterpart >= 0 && counterpart < width_;
    const int difference = settings_.left_right_check && inside ? Difference(i, counterpart) : 0;
    const int margin = winner.second == 0 ? 0 : 255 * (winner.second - winner.best) / winner.second;
    const int confidence = std::max<int>(margin >> std::min(difference, 8), kLeastConfidence);
    const InvalidReason reason = Judge(winner, left, x, y, inside, stored, difference, confidence);
    const bool valid = reason == InvalidReason::kNone;
    disparity_row[x] = valid ? static_cast<uint16_t>(stored) : kInvalidDisparity;
    confidence_row[x] = valid ? static_cast<uint8_t>(confidence) : 0;
    reason_row[x] = static_cast<uint8_t>(reason);
  }
}

}  // namespace vs
