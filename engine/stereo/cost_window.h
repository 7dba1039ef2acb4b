#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/image/image.h"
#include "engine/stereo/padded_picture.h"
#include "engine/stereo/pixel_cost.h"
#include "engine/stereo/sgm_settings.h"

namespace vs {

// The cost that paths run over: the pixel cost, averaged over a neighbourhood of the left view at
// constant disparity, in up to two steps.
//
// 1. Window of width M x height N, if M * N > 1: the rounded mean (sum + M * N / 2) / (M * N), in
//    integers, of the costs at x - M / 2 .. x - M / 2 + M - 1 and rows likewise. Columns and rows
//    beyond the border count as the border's own.
// 2. smooth_cost: with avg(a, b) = (a + b + 1) >> 1, horizontally
//      avg(C(x), avg(C(x-1), C(x+1)))
//    then the same vertically on that result; a neighbour that is outside the picture or whose
//    grey in the left picture differs from the centre's by more than smooth_cost_gate is replaced
//    by the centre.
//
// A cell whose counterpart is outside the right picture holds OutsideCost() before and after.
class CostRows {
 public:
  // `guide` is the left picture as the camera saw it; all must stay alive.
  void Prepare(const PaddedPicture* left, const PaddedPicture* right, const GreyImage* guide,
               const SgmSettings& settings);
  // The cost of cell (x, y, i) goes to cost[x * num_disparities + i]. Quick when called for rows in
  // order, for what neighbouring rows share is kept.
  void Row(int y, uint8_t* cost);

 private:
  // The last few rows of an intermediate result.
  template <class T>
  class Ring {
   public:
    void Reset(int rows, size_t row_size) {
      held_.assign(static_cast<size_t>(rows), -1);
      row_size_ = row_size;
      values_.resize(rows * row_size);
    }
    bool Holds(int y) const { return held_[Slot(y)] == y; }
    // Room for row y, which replaces an older one.
    T* Take(int y) {
      held_[Slot(y)] = y;
      return At(y);
    }
    T* At(int y) { return values_.data() + Slot(y) * row_size_; }

   private:
    size_t Slot(int y) const { return static_cast<size_t>(y) % held_.size(); }
    std::vector<int> held_;
    std::vector<T> values_;
    size_t row_size_ = 0;
  };

  bool HasWindow() const { return settings_.window_width * settings_.window_height > 1; }
  size_t RowSize() const;
  const uint16_t* SumRow(int y);         // sums over M columns
  void WindowRow(int y, uint8_t* cost);  // after step 1
  const uint8_t* AcrossRow(int y);       // after the horizontal half of step 2
  void ResetOutside(uint8_t* cost) const;

  SgmSettings settings_;
  const GreyImage* guide_ = nullptr;
  int width_ = 0;
  int height_ = 0;
  PixelCost pixel_cost_;
  std::vector<uint8_t> row_;
  std::vector<uint16_t> total_;
  Ring<uint16_t> sums_;
  Ring<uint8_t> across_;
};

}  // namespace vs
