#include "engine/stereo/cpu/sweep.h"

#include <algorithm>
#include <cstring>
#include <thread>

namespace vs::cpu {
namespace {

// The neighbour is at most two rows away, so it is worth looking a few times before giving way.
void WaitUntil(const std::atomic<int>& count, int least) {
  for (int looks = 0; count.load(std::memory_order_acquire) < least; ++looks) {
    if (looks > 200) std::this_thread::yield();
  }
}

}  // namespace

bool Sweep::Prepare(const SweepFrame* frame, int directions, bool backward, int blocks) {
  frame_ = frame;
  directions_ = directions;
  backward_ = backward;
  used_blocks_ = blocks;
  const Plan& plan = frame->plan;
  while (static_cast<int>(blocks_.size()) < blocks) blocks_.push_back(std::make_unique<Block>());
  for (int b = 0; b < blocks; ++b) {
    Block& block = *blocks_[b];
    const auto border = [&](int n) {
      const int i = plan.width * n / blocks;
      return backward ? plan.width - i : i;
    };
    block.begin = std::min(border(b), border(b + 1));
    block.end = std::max(border(b), border(b + 1));
    block.begun = 0;
    block.done = 0;
    block.p2.resize(ByteStride() * 4);
    block.like.resize(ByteStride() * 2);
    if (!block.costs.Prepare(frame->kernels, &plan, frame->kind, block.begin, block.end)) {
      return false;
    }
  }
  const auto cell = static_cast<size_t>(plan.cell);
  const auto ring = static_cast<size_t>(RingRows());
  const size_t line = static_cast<size_t>(plan.width + plan.height) * cell;
  if (along_.Reserve(ring * cell) == nullptr) return false;
  if (right_.Reserve(ring * 2 * cell) == nullptr) return false;
  if (directions >= 2) {
    uint8_t* across = across_.Reserve(plan.width * cell);
    if (across == nullptr) return false;
    std::memset(across, 0, plan.width * cell);
  }
  for (int d = 0; d < directions - 2; ++d) {
    uint8_t* diagonal = diagonals_[d].Reserve(line);
    if (diagonal == nullptr) return false;
    std::memset(diagonal, 0, line);
  }
  return true;
}

size_t Sweep::Bytes() const {
  size_t bytes = along_.Bytes() + across_.Bytes() + right_.Bytes() + diagonals_[0].Bytes() +
                 diagonals_[1].Bytes();
  for (const auto& block : blocks_)
    bytes += block->costs.Bytes() + block->p2.size() + block->like.size();
  return bytes;
}

uint8_t* Sweep::Ring(CellMemory& memory, int k, size_t size) const {
  return memory.Reserve(0) + static_cast<size_t>(k % RingRows()) * size;
}

void Sweep::Rows(int block, int first, int rows, SweepMode mode) {
  for (int k = first; k < first + rows; ++k) OneRow(block, k, mode);
}

void Sweep::PenaltyRows(Block* block, int y) const {
  const Plan& plan = frame_->plan;
  const int step = backward_ ? -1 : 1;
  const uint8_t* grey = plan.guide + y * plan.guide_stride;
  const uint8_t* before = plan.guide + std::clamp(y - step, 0, plan.height - 1) * plan.guide_stride;
  // By direction: from where the path comes. At the picture's border it comes from nowhere and any
  // penalty will do.
  const uint8_t* from[] = {grey - step, before, before - step, before + step};
  for (int d = 0; d < directions_; ++d) {
    frame_->kernels->penalty_row(frame_->penalties, grey + block->begin, from[d] + block->begin,
                                 block->end - block->begin,
                                 block->p2.data() + d * ByteStride() + block->begin);
  }
}

void Sweep::CostRows(Block* block, SweepRow* row) const {
  const Plan& plan = frame_->plan;
  const int y = row->y;
  row->here = block->costs.Row(y);
  if (plan.gate < 0) return;
  // At the border the row is its own neighbour.
  row->above = y > 0 ? block->costs.Row(y - 1) : row->here;
  row->below = y + 1 < plan.height ? block->costs.Row(y + 1) : row->here;
  const uint8_t* grey = plan.guide + y * plan.guide_stride + block->begin;
  const auto like = [&](const uint8_t* other, uint8_t* out) {
    frame_->kernels->likeness_row(plan.gate, grey, other, block->end - block->begin,
                                  out + block->begin);
    return out;
  };
  row->like_above = like(grey - plan.guide_stride, block->like.data());
  row->like_below = like(grey + plan.guide_stride, block->like.data() + ByteStride());
}

void Sweep::OneRow(int number, int k, SweepMode mode) {
  const Plan& plan = frame_->plan;
  Block& block = *blocks_[number];
  const bool is_first = number == 0;
  const bool is_last = number == used_blocks_ - 1;
  const bool selects_right = mode != SweepMode::kStore && plan.right_view;
  const int y = ImageRow(k);
  const auto row_bytes = static_cast<size_t>(plan.width) * plan.cell;

  SweepRow row{.y = y, .backward = backward_};
  CostRows(&block, &row);
  PenaltyRows(&block, y);
  for (int d = 0; d < directions_; ++d) {
    row.p2[d] = block.p2.data() + d * ByteStride();
  }
  row.along = Ring(along_, k, static_cast<size_t>(plan.cell));
  row.across = across_.Reserve(0);
  for (int d = 0; d < 2; ++d) row.diagonal[d] = diagonals_[d].Reserve(0);
  if (frame_->sums != nullptr) row.sums = frame_->sums + y * row_bytes;
  row.winners = WinnerRow::In(
      frame_->winners + static_cast<size_t>(y) * WinnerRow::kPlanes * plan.width, plan.width);
  const auto cell = static_cast<size_t>(plan.cell);
  if (selects_right) {
    row.right_state = Ring(right_, k, 2 * cell);
    row.right_index = frame_->right_index + static_cast<size_t>(y) * plan.width;
  }

  const auto sweep = [&](int begin, int end) {  // columns in the sweep's order, from 0
    row.begin = backward_ ? block.end - end : block.begin + begin;
    row.end = backward_ ? block.end - begin : block.begin + end;
    frame_->kernels->sweep_row(plan, directions_, mode, row);
  };
  const int columns = block.end - block.begin;
  if (is_first) {
    std::memset(row.along, 0, cell);
    if (selects_right) {  // see RightWinners
      std::memset(row.right_state, backward_ ? 254 : 255, cell);
      std::memset(row.right_state + cell, 0, cell);
    }
  } else {
    WaitUntil(blocks_[number - 1]->done, k + 1);
  }
  if (used_blocks_ == 1) {
    sweep(0, columns);
  } else {
    sweep(0, 1);
    block.begun.store(k + 1, std::memory_order_release);
    sweep(1, columns - 1);
    if (!is_last) WaitUntil(blocks_[number + 1]->begun, k);
    sweep(columns - 1, columns);
    block.done.store(k + 1, std::memory_order_release);
  }
}

}  // namespace vs::cpu
