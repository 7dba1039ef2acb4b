#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include "engine/stereo/cell_memory.h"
#include "engine/stereo/cpu/cost_source.h"
#include "engine/stereo/cpu/kernels.h"

namespace vs::cpu {

// What the sweeps of a frame share.
struct SweepFrame {
  const Kernels* kernels = nullptr;
  Plan plan;
  CostKind kind = CostKind::kSad;
  PenaltySteps penalties;
  uint8_t* sums = nullptr;         // S: [y][x][cell]; null when one sweep does it all
  uint8_t* winners = nullptr;      // [y]: a WinnerRow
  uint8_t* right_index = nullptr;  // [y][x]
};

// One sweep over a picture (kernels.h), shared among threads by blocks of columns. A block waits
// for what it needs from its neighbours, row by row:
//   the block before must have finished the row, for the path along it;
//   the block after must have begun the row before, for the diagonal that comes from there.
// So the threads follow each other like the teeth of a comb, at most two rows apart each.
class Sweep {
 public:
  // `directions` 1..4; `blocks` at least 1, each at least two columns wide. False when there is not
  // enough memory.
  bool Prepare(const SweepFrame* frame, int directions, bool backward, int blocks);
  // Sweeps `rows` rows, beginning with row `first` (counted in the sweep's order), of block `block`
  // (likewise). Rows must be swept in order; for a sweep of one direction, and one block, any row
  // may be the first.
  void Rows(int block, int first, int rows, SweepMode mode);
  // Of the memory that it keeps.
  size_t Bytes() const;

 private:
  struct Block {
    int begin = 0;  // columns
    int end = 0;
    CostSource costs;
    std::vector<uint8_t> p2;    // by direction
    std::vector<uint8_t> like;  // above, below
    // Rows of which the first column, and all columns, are done.
    std::atomic<int> begun = 0;
    std::atomic<int> done = 0;
  };

  int ImageRow(int k) const { return backward_ ? frame_->plan.height - 1 - k : k; }
  // Rows that are being swept at once: each block is at most two rows ahead of the next.
  int RingRows() const { return 2 * used_blocks_ + 2; }
  // Of a row of bytes by column that a kernel writes.
  size_t ByteStride() const { return static_cast<size_t>(frame_->plan.width) + 64; }
  uint8_t* Ring(CellMemory& memory, int k, size_t size) const;
  void PenaltyRows(Block* block, int y) const;
  void CostRows(Block* block, SweepRow* row) const;
  void OneRow(int block, int k, SweepMode mode);

  const SweepFrame* frame_ = nullptr;
  int directions_ = 0;
  bool backward_ = false;
  std::vector<std::unique_ptr<Block>> blocks_;
  int used_blocks_ = 0;
  CellMemory along_;   // a ring of cells, by row
  CellMemory across_;  // a row of cells
  CellMemory diagonals_[2];
  CellMemory right_;  // a ring of two cells each
};

}  // namespace vs::cpu
