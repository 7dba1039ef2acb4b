#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/stereo/filter_kernels.h"
#include "engine/stereo/winner_row.h"

namespace vs::cpu {

// The inner loops of the cpu matcher. They are written once (kernels_of.h) over a small set of
// vector operations (simd_*.h) and compiled once for each instruction set; which one runs is chosen
// when the program starts. Nothing here owns memory.
//
// The striped layout (Farrar 2007). The costs of one pixel for all disparities, a cell, are
// `stripes` vectors of `lanes` bytes; index i of the search range lies in vector i % stripes, lane
// i / stripes. So the neighbours i - 1 and i + 1 of a whole vector are its neighbouring vectors,
// and only the outermost two need a shift across lanes. Cells hold stripes * lanes >=
// num_disparities bytes; what is beyond the range holds kBeyond or more, so that no path ever comes
// from there.
//
// The right view is kept mirrored (pixel x at u = width - 1 - x) and striped likewise: place
// u + cell bytes, row (place % stripes), column place / stripes. Then the counterparts of one left
// pixel for all indices, u = width - 1 - x + min_disparity + i, are `stripes` unaligned loads.

inline constexpr uint8_t kBeyond = 191;

// Which cost (pixel_cost.h) by which features; the number is the bytes of a census code.
enum class CostKind : uint8_t {
  kCensus3,
  kCensus6,
  kCensus8,
  kAdCensus3,
  kAdCensus6,
  kAdCensus8,
  kSad,
  kBirchfieldTomasi,
};
inline constexpr int kCostKinds = 8;

// What is the same for all pixels of a frame.
struct Plan {
  int width = 0;
  int height = 0;
  int min_disparity = 0;
  int num_disparities = 0;
  int stripes = 0;
  int cell = 0;                             // bytes of a cell: stripes * lanes
  size_t right_stride = 0;                  // bytes of a striped row of the right view
  int planes = 0;                           // feature planes of a view
  const uint8_t* left_features = nullptr;   // [y][plane][x]
  const uint8_t* right_features = nullptr;  // [y][plane][stripe][right_stride]
  uint8_t limit = 0;                        // ad_limit or grey_limit
  uint8_t outside = 0;                      // OutsideCost
  int window_width = 1;
  int window_height = 1;
  int gate = -1;  // smooth_cost_gate; -1: the costs are not smoothed
  // The left picture as the camera saw it, going on beyond its border: for whoever asks for
  // penalties and likeness.
  const uint8_t* guide = nullptr;
  size_t guide_stride = 0;
  uint8_t p1 = 0;
  bool right_view = false;          // the right view's winners are wanted
  const uint8_t* layout = nullptr;  // what Kernels::layout wrote
};

// Bytes of a cell's layout, in cells.
inline constexpr int kLayoutCells = 3;

// Costs of row y for the columns [begin, end), smoothed along the row if plan.gate >= 0: cell x
// goes to row + x * cell.
struct CostRow {
  int y = 0;
  int begin = 0;
  int end = 0;
  uint8_t* row = nullptr;
  const uint8_t* like_before = nullptr;  // see Kernels::likeness_row; columns [begin, end]
};

// The sums of `costs`, a row of cells before smoothing, over the window's width, for the columns
// [begin, end). Reads the columns that the window reaches.
struct WindowSums {
  int begin = 0;
  int end = 0;
  const uint8_t* costs = nullptr;
  uint16_t* sums = nullptr;  // one for each byte of a cell
};

// Costs of a row for the columns [begin, end) from the sums of the window's rows, smoothed along
// the row like CostRow.
struct WindowRow {
  int begin = 0;
  int end = 0;
  const uint16_t* const* sums = nullptr;  // window_height rows
  uint8_t* row = nullptr;
  const uint8_t* like_before = nullptr;
};

// One row, or a part of it, of a sweep over the picture that adds up to four directions at once:
// along the row, across the rows, and the two diagonals, always coming from rows that were swept
// before. A backward sweep goes from the bottom right corner, a forward one from the top left.
struct SweepRow {
  int y = 0;
  int begin = 0;  // columns [begin, end), from the right if backward
  int end = 0;
  bool backward = false;
  const uint8_t* above = nullptr;  // cost rows y - 1, y, y + 1; the row itself at the border
  const uint8_t* here = nullptr;
  const uint8_t* below = nullptr;
  const uint8_t* like_above = nullptr;  // see Kernels::likeness_row, by column
  const uint8_t* like_below = nullptr;
  uint8_t* along = nullptr;   // L of the pixel before in this row: one cell, kept up to date
  uint8_t* across = nullptr;  // L of the row before: [x]
  uint8_t* diagonal[2] = {};  // L of the diagonals; a line stays in its place: width + height cells
  const uint8_t* p2[4] = {};  // P2 by column, for each direction
  uint8_t* sums = nullptr;    // S of this row: [x]
  WinnerRow winners;          // when finishing
  // The right view's winners: those that are still being found, two cells, kept up to date; and the
  // row that takes their indices, by column. Null when nobody wants them.
  uint8_t* right_state = nullptr;
  uint8_t* right_index = nullptr;
};

enum class SweepMode : uint8_t {
  kStore,   // S = what this sweep adds
  kFinish,  // add what the other sweep stored, and select the winners
  kOnly,    // there is no other sweep: select the winners
};

// Census codes of a row of pixels (census.h), which must have at least `lanes` pixels.
struct CensusRowWork {
  const uint8_t* centre = nullptr;        // the row in a picture that goes on beyond it
  const ptrdiff_t* neighbours = nullptr;  // see CensusSteps
  int count = 0;
  int width = 0;
  uint8_t* codes = nullptr;  // [byte][x]
};

// P2 by grey step as the penalties fall: P2(g) is penalty - the number of limits that are at most
// g.
struct PenaltySteps {
  uint8_t penalty = 0;
  int count = 0;
  uint8_t limits[64] = {};  // rising, from 1
};

struct Kernels {
  const char* name;  // "avx512", "avx2", "portable"
  int lanes;
  // The least supported number of stripes for a range.
  int (*stripes)(int num_disparities);
  // Writes what each byte of a cell stands for, the same for all cells of a frame: its index i;
  // 0xff beyond the range, else 0; the cost of the outside, kBeyond beyond the range.
  void (*layout)(const Plan& plan, uint8_t* out);
  void (*census_row)(const CensusRowWork& work);
  // A row of one plane of the right view in the striped layout: `striped` has plan.stripes rows of
  // plan.right_stride bytes. May read up to `lanes` bytes before the row.
  void (*stripe_row)(const Plan& plan, const uint8_t* row, uint8_t* striped);
  // P2 between the pixels of two rows of grey values, count pixels each; may write up to the next
  // multiple of `lanes`, and read as far.
  void (*penalty_row)(const PenaltySteps& steps, const uint8_t* grey, const uint8_t* from,
                      int count, uint8_t* p2);
  // Where smoothing may mix pixels: 0xff where the grey values of two rows differ by at most
  // `gate`, else 0. Writes and reads as far as penalty_row.
  void (*likeness_row)(int gate, const uint8_t* grey, const uint8_t* from, int count,
                       uint8_t* like);
  void (*cost_row)(const Plan& plan, CostKind kind, const CostRow& work);
  void (*window_sums)(const Plan& plan, const WindowSums& work);
  void (*window_row)(const Plan& plan, const WindowRow& work);
  // `directions` 1..4 of this sweep, in the order along, across, diagonals.
  void (*sweep_row)(const Plan& plan, int directions, SweepMode mode, const SweepRow& work);
  const FilterKernels* filters;
};

// Null when this processor (or this build) cannot run them.
const Kernels* Avx512Kernels();
const Kernels* Avx2Kernels();
const Kernels* PortableKernels();

}  // namespace vs::cpu
