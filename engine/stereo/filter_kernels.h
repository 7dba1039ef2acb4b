#pragma once

#include <cstdint>

#include "engine/stereo/sgm_settings.h"
#include "engine/stereo/winner_row.h"

namespace vs {

// The inner loops of what follows the sums, a row at a time. Compiled once for every processor and
// once for each instruction set that a matcher knows; they all compute the same.
//
// The rows that the filters read hold stored disparities, widened: they may be read kFilterMargin
// pixels to the left of x = 0 and kFilterMargin + kFilterLanes to the right of the last pixel.
inline constexpr int kFilterMargin = 3;
inline constexpr int kFilterLanes = 64;

// A row of winners and what JudgeRow of selection.h needs to know to make disparities of it.
struct JudgedRow {
  WinnerRow winners;
  const uint8_t* right_index = nullptr;  // null without left_right_check
  // Rows y - 2 .. y + 2 of the left picture; the border row in place of those beyond.
  const uint8_t* left[5] = {};
  int width = 0;  // at least kMinPictureSize
  int min_disparity = 0;
  int last_index = 0;
  int first_stored = 0;  // the stored disparity of index 0
  SubPixel sub_pixel = SubPixel::kOff;
  bool lenient = false;
  int tolerance = 0;
  int least_percent = 100;  // 100 - uniqueness_percent
  int min_confidence = 0;
  uint16_t* disparity = nullptr;
  uint8_t* confidence = nullptr;
  uint8_t* reason = nullptr;
};

struct FilterKernels {
  void (*judge)(const JudgedRow& row);
  // The median of 3 x 3 or 5 x 5 pixels: `rows` are the 3 or 5 rows around.
  void (*median3)(const uint16_t* const* rows, int width, uint16_t* out);
  void (*median5)(const uint16_t* const* rows, int width, uint16_t* out);
  // The gated median of 5 x 5 pixels (gated_filter.h) where the centre is valid, anything where it
  // is not; `greys` are as wide as the rows.
  void (*gated_median5)(const uint16_t* const* rows, const uint16_t* const* greys, int width,
                        int gate, uint16_t* out);
};

// For every processor.
const FilterKernels& PlainFilterKernels();

}  // namespace vs
