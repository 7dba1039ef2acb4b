#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/stereo/filter_kernels.h"

namespace vs {

// Copies of the rows around the one being filtered, as wide as FilterKernels want them. Each row is
// copied once when the rows are asked for in order.
class WidenedRows {
 public:
  // How the picture goes on beyond its border.
  enum class Border : uint8_t { kRepeat, kZero };

  // `memory` keeps its room between calls.
  WidenedRows(int width, int height, int rows, Border border, std::vector<uint16_t>* memory)
      : width_(width),
        height_(height),
        rows_(rows),
        border_(border),
        stride_(static_cast<size_t>(width) + size_t{2} * kFilterMargin + kFilterLanes) {
    // One row of zeros at the end.
    memory->assign(stride_ * (static_cast<size_t>(rows) + 1), 0);
    memory_ = memory->data();
  }

  // Makes `around` the rows y - rows / 2 .. y + rows / 2; `row_of(y)` gives a row of the picture.
  template <class RowOf>
  void Load(int y, const RowOf& row_of, const uint16_t** around) {
    for (int k = 0; k < rows_; ++k) {
      const int wanted = y + k - rows_ / 2;
      const int from = std::clamp(wanted, 0, height_ - 1);
      if (from != wanted && border_ == Border::kZero) {
        around[k] = memory_ + stride_ * rows_ + kFilterMargin;
        continue;
      }
      uint16_t* row = memory_ + stride_ * (from % rows_) + kFilterMargin;
      if (from > last_ || last_ < 0) Copy(row_of(from), row);
      last_ = std::max(last_, from);
      around[k] = row;
    }
  }

 private:
  template <class T>
  void Copy(const T* from, uint16_t* row) const {
    std::copy_n(from, width_, row);
    if (border_ == Border::kZero) return;
    std::fill(row - kFilterMargin, row, row[0]);
    std::fill(row + width_, row + width_ + kFilterMargin + kFilterLanes, row[width_ - 1]);
  }

  int width_;
  int height_;
  int rows_;
  Border border_;
  size_t stride_;
  uint16_t* memory_;
  int last_ = -1;  // the last row of the picture that was copied
};

}  // namespace vs
