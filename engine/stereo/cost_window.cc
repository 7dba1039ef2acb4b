#include "engine/stereo/cost_window.h"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <cstring>

namespace vs {
namespace {

uint8_t Average(uint8_t a, uint8_t b) { return static_cast<uint8_t>((a + b + 1) >> 1); }

// avg(centre, avg(before, after)) for `count` disparities.
void SmoothCell(const uint8_t* before, const uint8_t* centre, const uint8_t* after, size_t count,
                uint8_t* __restrict out) {
  for (size_t i = 0; i < count; ++i) out[i] = Average(centre[i], Average(before[i], after[i]));
}

void Add(const uint8_t* __restrict values, size_t count, uint16_t* __restrict sums) {
  for (size_t i = 0; i < count; ++i) sums[i] = static_cast<uint16_t>(sums[i] + values[i]);
}

void Add(const uint16_t* __restrict values, size_t count, uint16_t* __restrict sums) {
  for (size_t i = 0; i < count; ++i) sums[i] = static_cast<uint16_t>(sums[i] + values[i]);
}

// (sum + divisor / 2) / divisor by a reciprocal. Exact: with 2^k <= divisor < 2^(k+1) and sums
// below 2^14 (63 * 225 + 112), the reciprocal's error adds less than 2^14 / 2^(16+k) < 1 / divisor.
void DivideRounded(const uint16_t* __restrict sums, size_t count, unsigned divisor,
                   uint8_t* __restrict out) {
  const int shift = 16 + std::bit_width(divisor) - 1;
  const uint32_t reciprocal = ((1U << shift) + divisor - 1) / divisor;
  const uint32_t half = divisor / 2;
  for (size_t i = 0; i < count; ++i) {
    out[i] = static_cast<uint8_t>(((sums[i] + half) * reciprocal) >> shift);
  }
}

}  // namespace

void CostRows::Prepare(const PaddedPicture* left, const PaddedPicture* right,
                       const GreyImage* guide, const SgmSettings& settings) {
  settings_ = settings;
  guide_ = guide;
  width_ = left->width();
  height_ = left->height();
  pixel_cost_.Prepare(left, right, settings);
  const bool window = HasWindow();
  row_.resize(window || settings.smooth_cost ? RowSize() : 0);
  total_.resize(window ? static_cast<size_t>(settings.num_disparities) : 0);
  sums_.Reset(window ? settings.window_height : 1, window ? RowSize() : 0);
  across_.Reset(3, settings.smooth_cost ? RowSize() : 0);
}

size_t CostRows::RowSize() const {
  return static_cast<size_t>(width_) * static_cast<size_t>(settings_.num_disparities);
}

const uint16_t* CostRows::SumRow(int y) {
  if (sums_.Holds(y)) return sums_.At(y);
  pixel_cost_.Row(y, row_.data());
  uint16_t* sums = sums_.Take(y);
  const auto disparities = static_cast<size_t>(settings_.num_disparities);
  std::memset(sums, 0, RowSize() * sizeof(uint16_t));
  for (int x = 0; x < width_; ++x) {
    for (int k = 0; k < settings_.window_width; ++k) {
      const int from = std::clamp(x - settings_.window_width / 2 + k, 0, width_ - 1);
      Add(row_.data() + from * disparities, disparities, sums + x * disparities);
    }
  }
  return sums;
}

void CostRows::WindowRow(int y, uint8_t* cost) {
  if (!HasWindow()) return pixel_cost_.Row(y, cost);
  const int top = y - settings_.window_height / 2;
  for (int k = 0; k < settings_.window_height; ++k) SumRow(std::clamp(top + k, 0, height_ - 1));
  const auto disparities = static_cast<size_t>(settings_.num_disparities);
  const auto cells = static_cast<unsigned>(settings_.window_width * settings_.window_height);
  for (int x = 0; x < width_; ++x) {
    std::fill(total_.begin(), total_.end(), uint16_t{0});
    for (int k = 0; k < settings_.window_height; ++k) {
      const uint16_t* sums = sums_.At(std::clamp(top + k, 0, height_ - 1));
      Add(sums + x * disparities, disparities, total_.data());
    }
    DivideRounded(total_.data(), disparities, cells, cost + x * disparities);
  }
  ResetOutside(cost);
}

const uint8_t* CostRows::AcrossRow(int y) {
  if (across_.Holds(y)) return across_.At(y);
  WindowRow(y, row_.data());
  uint8_t* out = across_.Take(y);
  const uint8_t* grey = guide_->Row(y);
  const auto disparities = static_cast<size_t>(settings_.num_disparities);
  const auto alike = [&](int a, int b) {
    return b >= 0 && b < width_ && std::abs(grey[a] - grey[b]) <= settings_.smooth_cost_gate;
  };
  for (int x = 0; x < width_; ++x) {
    const uint8_t* centre = row_.data() + x * disparities;
    SmoothCell(alike(x, x - 1) ? centre - disparities : centre, centre,
               alike(x, x + 1) ? centre + disparities : centre, disparities, out + x * disparities);
  }
  return out;
}

void CostRows::Row(int y, uint8_t* cost) {
  if (!settings_.smooth_cost) return WindowRow(y, cost);
  const uint8_t* above = AcrossRow(std::max(y - 1, 0));
  const uint8_t* here = AcrossRow(y);
  const uint8_t* below = AcrossRow(std::min(y + 1, height_ - 1));
  const uint8_t* grey_above = guide_->Row(std::max(y - 1, 0));
  const uint8_t* grey = guide_->Row(y);
  const uint8_t* grey_below = guide_->Row(std::min(y + 1, height_ - 1));
  const auto disparities = static_cast<size_t>(settings_.num_disparities);
  for (int x = 0; x < width_; ++x) {
    const size_t cell = x * disparities;
    const auto alike = [&](const uint8_t* other) {
      return std::abs(grey[x] - other[x]) <= settings_.smooth_cost_gate;
    };
    SmoothCell((alike(grey_above) ? above : here) + cell, here + cell,
               (alike(grey_below) ? below : here) + cell, disparities, cost + cell);
  }
  ResetOutside(cost);
}

void CostRows::ResetOutside(uint8_t* cost) const {
  const int outside = OutsideCost(settings_);
  const int disparities = settings_.num_disparities;
  for (int x = 0; x < width_; ++x, cost += disparities) {
    const InsideRange inside = InsideOf(x, width_, settings_);
    std::memset(cost, outside, static_cast<size_t>(inside.begin));
    std::memset(cost + inside.end, outside, static_cast<size_t>(disparities - inside.end));
  }
}

}  // namespace vs
