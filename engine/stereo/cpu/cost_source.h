#pragma once

#include <cstdint>
#include <vector>

#include "engine/stereo/cell_memory.h"
#include "engine/stereo/cpu/kernels.h"

namespace vs::cpu {

// The cost rows of some columns, computed when asked for and kept for as long as rows that are
// asked for in order need them. For one thread.
class CostSource {
 public:
  // For the columns [begin, end) of a frame. False when there is not enough memory.
  bool Prepare(const Kernels* kernels, const Plan* plan, CostKind kind, int begin, int end);
  // Row y, smoothed along the row if the plan says so; valid until a row more than one away is
  // asked for.
  const uint8_t* Row(int y);
  size_t Bytes() const { return rows_.Bytes() + window_rows_.Bytes() + like_before_.size(); }

 private:
  bool HasWindow() const { return plan_->window_width * plan_->window_height > 1; }
  size_t RowBytes() const { return static_cast<size_t>(plan_->width) * plan_->cell; }
  const uint8_t* LikeBefore(int y);
  uint16_t* Sums(int y);

  const Kernels* kernels_ = nullptr;
  const Plan* plan_ = nullptr;
  CostKind kind_ = CostKind::kSad;
  int begin_ = 0;
  int end_ = 0;
  CellMemory rows_;                   // three rows
  CellMemory window_rows_;            // a row of costs, then the sums of window_height rows
  std::vector<uint8_t> like_before_;  // CostRow::like_before
  std::vector<int> held_rows_;
  std::vector<int> held_sums_;
  std::vector<const uint16_t*> window_;
};

}  // namespace vs::cpu
