#include "engine/stereo/selection.h"

#include <algorithm>
#include <cstring>
#include <numeric>

#include "engine/stereo/pixel_cost.h"

namespace vs {
namespace {

uint8_t LeastOf(const uint8_t* values, int begin, int end) {
  uint8_t least = 255;
  for (int i = begin; i < end; ++i) least = std::min(least, values[i]);
  return least;
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

void JudgeRow(const SgmSettings& settings, const GreyImage& left, int y, const WinnerRow& winners,
              const uint8_t* right_index, const FilterKernels& kernels, DisparityMap* map) {
  const auto left_row = [&](int v) { return left.Row(std::clamp(v, 0, left.height() - 1)); };
  kernels.judge(
      {.winners = winners,
       .right_index = settings.left_right_check ? right_index : nullptr,
       .left = {left_row(y - 2), left_row(y - 1), left_row(y), left_row(y + 1), left_row(y + 2)},
       .width = left.width(),
       .min_disparity = settings.min_disparity,
       .last_index = settings.num_disparities - 1,
       .first_stored = kDisparityScale * (settings.min_disparity - DisparityOffset(settings)),
       .sub_pixel = settings.sub_pixel,
       .lenient = settings.left_right_lenient,
       .tolerance = settings.left_right_tolerance,
       .least_percent = 100 - settings.uniqueness_percent,
       .min_confidence = settings.min_confidence,
       .disparity = map->disparity.Row(y),
       .confidence = map->confidence.Row(y),
       .reason = map->reason.Row(y)});
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
