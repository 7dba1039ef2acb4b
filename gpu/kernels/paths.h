// Costs along paths, and their sums (engine/stereo/path_cost.h).
//
// A warp walks a line of pixels; each lane holds L of its 4 or 8 disparities. The two directions of
// a line go with two warps of one block. They start at its two ends and store what they find; where
// they meet they wait for each other and go on, now adding to what the other has stored. So all
// directions are under way at once, and two of them share a volume that is written twice and read
// once. Saturation cannot occur within a volume: no L exceeds 127.
//
// Floors at 648 x 482, 256 disparities, 8 directions, computed from an H200's data sheet: 640 M
// cells at 5.5 instructions for two of them take 0.11 ms; reading costs and writing sums moves 1.6
// GB, of which neighbouring lines share a part in the cache: 0.2 to 0.4 ms. A chain of 482 steps
// takes 0.07 ms.
#pragma once

#include <cstdint>

#include "gpu/frame.h"
#include "gpu/kernels/simt.h"

namespace vs::gpu {

// Consecutive cells of a pixel, a byte each.
template <int kCells>
struct alignas(kCells) CellBytes {
  static constexpr int kWords = kCells / 4;
  uint32_t word[kWords];
};

// Greater than any path cost, and P1 can be added.
inline constexpr uint32_t kNoCell = 0x3fff;

// L of a lane's cells, two to a word: what devices with instructions for pairs like.
template <int kCells>
struct PairedPath {
  static constexpr int kWords = kCells / 2;
  uint32_t pairs[kWords] = {};

  // From L of the pixel before to L of the pixel with these costs, which is also returned.
  VS_DEVICE CellBytes<kCells> Advance(const CellBytes<kCells>& cost, uint32_t p1, uint32_t p2) {
    // Each pair with its lower neighbour: the last one of a lane with the first of the next.
    uint32_t below = ShuffleUp(pairs[kWords - 1], 1);
    uint32_t above = ShuffleDown(pairs[0], 1);
    if (Lane() == 0) below = Both(kNoCell);
    if (Lane() == kWarpSize - 1) above = Both(kNoCell);
    uint32_t shifted[kWords + 1];
    constexpr uint32_t kHighThenLow = 0x5432;
    shifted[0] = BytePermute(below, pairs[0], kHighThenLow);
    for (int w = 1; w < kWords; ++w) {
      shifted[w] = BytePermute(pairs[w - 1], pairs[w], kHighThenLow);
    }
    shifted[kWords] = BytePermute(pairs[kWords - 1], above, kHighThenLow);

    const uint32_t one_step = Both(p1);
    const uint32_t any_step = Both(p2);
    uint32_t least = Both(kNoCell);
    for (int w = 0; w < kWords; ++w) {
      uint32_t best = MinPairs(pairs[w], any_step);
      best = AddMinPairs(shifted[w], one_step, best);
      best = AddMinPairs(shifted[w + 1], one_step, best);
      const uint32_t c = BytePermute(cost.word[w / 2], 0, w % 2 == 0 ? 0x4140 : 0x4342);
      pairs[w] = AddPairs(c, best);
      least = MinPairs(least, pairs[w]);
    }
    least = WarpMin(Lesser(least & 0xffff, least >> 16));
    for (int w = 0; w < kWords; ++w) pairs[w] = SubtractPairs(pairs[w], Both(least));
    CellBytes<kCells> bytes;
    for (int w = 0; w < kCells / 4; ++w) {
      bytes.word[w] = BytePermute(pairs[2 * w], pairs[2 * w + 1], 0x6420);
    }
    return bytes;
  }
};

// The same with a word for each cell, for devices without such instructions.
template <int kCells>
struct PlainPath {
  uint32_t cells[kCells] = {};

  VS_DEVICE CellBytes<kCells> Advance(const CellBytes<kCells>& cost, uint32_t p1, uint32_t p2) {
    uint32_t before = ShuffleUp(cells[kCells - 1], 1);
    uint32_t above = ShuffleDown(cells[0], 1);
    if (Lane() == 0) before = kNoCell;
    if (Lane() == kWarpSize - 1) above = kNoCell;
    uint32_t least = kNoCell;
    for (int k = 0; k < kCells; ++k) {
      const uint32_t own = cells[k];
      const uint32_t after = k + 1 < kCells ? cells[k + 1] : above;
      const uint32_t best = Lesser(Lesser(own, Lesser(before, after) + p1), p2);
      cells[k] = ((cost.word[k / 4] >> (8 * (k % 4))) & 0xff) + best;
      least = Lesser(least, cells[k]);
      before = own;
    }
    least = WarpMin(least);
    CellBytes<kCells> bytes = {};
    for (int k = 0; k < kCells; ++k) {
      cells[k] -= least;
      bytes.word[k / 4] |= (cells[k] & 0xff) << (8 * (k % 4));
    }
    return bytes;
  }
};

// The pixels of a line in the order in which one of its directions comes by.
struct Way {
  int width;
  int height;
  int line;
  int dx;  // columns from row to row, walking downwards; lines leave at one side and enter again
           // at the other (path_cost.h)
  bool horizontal;
  bool backward;

  VS_DEVICE int Steps() const { return horizontal ? width : height; }

  // Step n: its pixel, and how P2 is found there, in one word: 256 * pixel + P2. P2 = 0 begins a
  // path anew, for then L of the pixel before makes no difference.
  VS_DEVICE uint32_t At(int n, const uint8_t* grey, const uint8_t* p2) const {
    const int m = backward ? Steps() - 1 - n : n;
    const int sign = backward ? -1 : 1;
    if (horizontal) {
      const int pixel = line * width + m;
      const uint32_t penalty = n == 0 ? 0U : p2[Distance(grey[pixel], grey[pixel - sign])];
      return static_cast<uint32_t>(pixel) << 8 | penalty;
    }
    const int wrapped = (line + dx * m) % width;
    const int x = wrapped < 0 ? wrapped + width : wrapped;
    const int pixel = m * width + x;
    const bool enters = dx != 0 && x == (sign * dx > 0 ? 0 : width - 1);
    const uint32_t penalty =
        n == 0 || enters ? 0U : p2[Distance(grey[pixel], grey[pixel - sign * (width + dx)])];
    return static_cast<uint32_t>(pixel) << 8 | penalty;
  }
};

template <int kCells>
VS_DEVICE CellBytes<kCells> LoadCells(const uint8_t* volume, uint32_t pixel, int pitch) {
  const int first = Lane() * kCells;
  if (first >= pitch) {
    CellBytes<kCells> none;
    for (uint32_t& word : none.word) word = 0xffffffffU;
    return none;
  }
  return *reinterpret_cast<const CellBytes<kCells>*>(volume + static_cast<size_t>(pixel) * pitch +
                                                     first);
}

template <int kCells>
VS_DEVICE void StoreCells(const CellBytes<kCells>& cells, uint32_t pixel, int pitch,
                          uint8_t* volume) {
  const int first = Lane() * kCells;
  if (first >= pitch) return;
  *reinterpret_cast<CellBytes<kCells>*>(volume + static_cast<size_t>(pixel) * pitch + first) =
      cells;
}

// Walks the steps [begin, end) of `way`. Memory answers late: costs are asked for kAhead steps
// before they are needed. Two should be enough, for the 37 warps of a multiprocessor at 648 x 482
// take turns; with four a thread needs 67 registers in place of 46 (says the compiler, for sm_90),
// and not all warps would fit at once.
template <bool kAdd, int kCells, class Path>
VS_DEVICE void Walk(const Frame& frame, const Way& way, int begin, int end, Path* path,
                    uint8_t* sums) {
  constexpr int kAhead = 2;
  static_assert(kWarpSize % kAhead == 0);
  const uint8_t* const grey = frame.grey[kLeft];
  const auto p1 = static_cast<uint32_t>(frame.settings.p1);
  const auto steps_from = [&](int n) {
    return way.At(Lesser(n + Lane(), end - 1), grey, frame.p2);
  };
  struct Cell {
    uint32_t step;
    CellBytes<kCells> cost;
    CellBytes<kCells> sum;
  };
  Cell now[kAhead];
  Cell next[kAhead];
  const auto load = [&](uint32_t steps, int k, Cell* cell) {
    cell->step = FromLane(steps, k);
    cell->cost = LoadCells<kCells>(frame.costs, cell->step >> 8, frame.pitch);
    if (kAdd) cell->sum = LoadCells<kCells>(sums, cell->step >> 8, frame.pitch);
  };
  if (begin >= end) return;
  uint32_t steps = steps_from(begin);  // each lane knows one of the next 32
  for (int k = 0; k < kAhead; ++k) load(steps, k, &next[k]);
  for (int n = begin; n < end; n += kWarpSize) {
    const uint32_t later_steps = steps_from(n + kWarpSize);
    for (int m = 0; m < kWarpSize && n + m < end; m += kAhead) {
      for (int k = 0; k < kAhead; ++k) now[k] = next[k];
      const bool last = m + kAhead == kWarpSize;
      for (int k = 0; k < kAhead; ++k) {
        load(last ? later_steps : steps, last ? k : m + kAhead + k, &next[k]);
      }
      for (int k = 0; k < kAhead; ++k) {
        if (n + m + k >= end) break;
        CellBytes<kCells> cells = path->Advance(now[k].cost, p1, now[k].step & 0xff);
        if (kAdd) {
          // What is carried from one byte to the next comes from cells that mean nothing.
          for (int w = 0; w < CellBytes<kCells>::kWords; ++w) cells.word[w] += now[k].sum.word[w];
        }
        StoreCells<kCells>(cells, now[k].step >> 8, frame.pitch, sums);
      }
    }
    steps = later_steps;
  }
}

inline constexpr int kWarpsOfPathBlock = 4;
inline constexpr int kLinesOfPathBlock = kWarpsOfPathBlock / 2;

// Block y is a volume of sums: two directions, the second of which may not be wanted.
template <int kCells, template <int> class Path>
VS_KERNEL WalkPaths(const Frame frame) {
  const int group = BlockY();
  // With so many directions a group has both of its own.
  const int enough = group < 2 ? 2 * (group + 1) : 5 + group;
  const bool both = frame.settings.directions >= enough;
  const int line = BlockX() * kLinesOfPathBlock + WarpInBlock() / 2;
  const Way way{.width = frame.width,
                .height = frame.height,
                .line = line,
                .dx = group == 2   ? 1
                      : group == 3 ? -1
                                   : 0,
                .horizontal = group == 0,
                .backward = WarpInBlock() % 2 == 1};
  const int steps = way.Steps();
  const bool walks =
      line < (way.horizontal ? frame.height : frame.width) && (both || !way.backward);
  const int half = way.backward ? steps - steps / 2 : steps / 2;
  uint8_t* const sums = frame.sums[group];
  Path<kCells> path;
  if (walks) Walk<false, kCells>(frame, way, 0, half, &path, sums);
  SyncBlock();
  if (!walks) return;
  if (both) {
    Walk<true, kCells>(frame, way, half, steps, &path, sums);
  } else {
    Walk<false, kCells>(frame, way, half, steps, &path, sums);
  }
}

// Which of both ways to hold a path the device likes; tests try both.
template <int kCells>
struct PathOfDevice {
#if defined(__CUDA_ARCH__) && __CUDA_ARCH__ < 900
  PlainPath<kCells> path;
#else
  PairedPath<kCells> path;
#endif
  VS_DEVICE CellBytes<kCells> Advance(const CellBytes<kCells>& cost, uint32_t p1, uint32_t p2) {
    return path.Advance(cost, p1, p2);
  }
};

// costs -> sums.
template <template <int> class Path = PathOfDevice, class Launch>
void SumPaths(Launch& launch, const Frame& frame) {
  const int lines = Greater(frame.height, frame.sum_count > 1 ? frame.width : 0);
  const Grid grid{(lines + kLinesOfPathBlock - 1) / kLinesOfPathBlock, frame.sum_count};
  constexpr int kThreads = kWarpsOfPathBlock * kWarpSize;
  if (frame.pitch <= 4 * kWarpSize) {
    launch(&WalkPaths<4, Path>, grid, kThreads, frame);
  } else {
    launch(&WalkPaths<8, Path>, grid, kThreads, frame);
  }
}

}  // namespace vs::gpu
