#include "engine/stereo/cpu/cost_source.h"

#include <algorithm>

namespace vs::cpu {
namespace {

constexpr int kRows = 3;

}  // namespace

bool CostSource::Prepare(const Kernels* kernels, const Plan* plan, CostKind kind, int begin,
                         int end) {
  kernels_ = kernels;
  plan_ = plan;
  kind_ = kind;
  begin_ = begin;
  end_ = end;
  held_rows_.assign(kRows, -1);
  if (rows_.Reserve(kRows * RowBytes()) == nullptr) return false;
  like_before_.resize(static_cast<size_t>(plan->width) + 1 + kernels->lanes);
  if (!HasWindow()) return true;
  held_sums_.assign(static_cast<size_t>(plan->window_height), -1);
  window_.resize(held_sums_.size());
  const size_t sums = RowBytes() * sizeof(uint16_t) * plan->window_height;
  return window_rows_.Reserve(RowBytes() + sums) != nullptr;
}

const uint8_t* CostSource::Row(int y) {
  const int slot = y % kRows;
  uint8_t* row = rows_.Reserve(0) + slot * RowBytes();
  if (held_rows_[slot] == y) return row;
  held_rows_[slot] = y;
  const uint8_t* like_before = LikeBefore(y);
  if (!HasWindow()) {
    kernels_->cost_row(
        *plan_, kind_,
        {.y = y, .begin = begin_, .end = end_, .row = row, .like_before = like_before});
    return row;
  }
  const int top = y - plan_->window_height / 2;
  for (int k = 0; k < plan_->window_height; ++k) {
    window_[k] = Sums(std::clamp(top + k, 0, plan_->height - 1));
  }
  kernels_->window_row(*plan_, {.begin = begin_,
                                .end = end_,
                                .sums = window_.data(),
                                .row = row,
                                .like_before = like_before});
  return row;
}

const uint8_t* CostSource::LikeBefore(int y) {
  if (plan_->gate < 0) return nullptr;
  const uint8_t* grey = plan_->guide + y * plan_->guide_stride + begin_;
  kernels_->likeness_row(plan_->gate, grey, grey - 1, end_ + 1 - begin_,
                         like_before_.data() + begin_);
  // At the border there is no neighbour.
  if (begin_ == 0) like_before_[0] = 0;
  return like_before_.data();
}

uint16_t* CostSource::Sums(int y) {
  uint8_t* costs = window_rows_.Reserve(0);
  const int slot = y % plan_->window_height;
  auto* sums = reinterpret_cast<uint16_t*>(costs + RowBytes()) + slot * RowBytes();
  if (held_sums_[slot] == y) return sums;
  held_sums_[slot] = y;
  // Smoothing looks one column farther than the row goes, the window half its width more.
  const int begin = std::max(begin_ - 1, 0);
  const int end = std::min(end_ + 1, plan_->width);
  const int reach = plan_->window_width;
  Plan unsmoothed = *plan_;
  unsmoothed.gate = -1;
  kernels_->cost_row(unsmoothed, kind_,
                     {.y = y,
                      .begin = std::max(begin - reach, 0),
                      .end = std::min(end + reach, plan_->width),
                      .row = costs});
  kernels_->window_sums(*plan_, {.begin = begin, .end = end, .costs = costs, .sums = sums});
  return sums;
}

}  // namespace vs::cpu
