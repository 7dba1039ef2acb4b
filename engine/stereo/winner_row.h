#pragma once

#include <cstdint>

namespace vs {

// What was found for each pixel of a row of the left view (selection.h), by column.
struct WinnerRow {
  uint8_t* index = nullptr;   // i of the least sum Z
  uint8_t* best = nullptr;    // Z
  uint8_t* second = nullptr;  // N, the least sum more than one index away
  uint8_t* before = nullptr;  // S at i - 1 and i + 1; anything where there is no such index
  uint8_t* after = nullptr;

  static constexpr int kPlanes = 5;
  // Its planes in one piece of memory, kPlanes * width bytes.
  static WinnerRow In(uint8_t* memory, int width) {
    return {memory, memory + width, memory + 2 * static_cast<long>(width),
            memory + 3 * static_cast<long>(width), memory + 4 * static_cast<long>(width)};
  }
};

}  // namespace vs
