#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/image/image.h"
#include "engine/stereo/sgm_settings.h"

namespace vs {

// The path costs of semi-global matching (Hirschmueller 2008, eq. 13) and their sum.
//
// For each direction r, along every line of pixels p in that direction (p - r is the pixel before):
//   T(p, i) = C(p, i) + min(L(p-r, i), L(p-r, i-1) + P1, L(p-r, i+1) + P1, P2(g))
//   L(p, i) = T(p, i) - min over k of T(p, k)
// where g = |grey(p) - grey(p-r)| in the left picture as the camera saw it. Neighbours i-1 and i+1
// outside the range do not exist. The first pixel of a line has T = C. As L has minimum 0, this is
// the usual recursion; as P2 + C <= 127, nothing here exceeds 127.
//   S(p, i) = min(255, sum over directions of L(p, i))
// With at most 4 directions and C + P2 <= 63 (the recommended settings) S never saturates.
// P1 = P2 = 0 gives L = C - min C: winner takes all.
//
// The fixed order of directions, so that a number of directions always means the same ones:
// from the left, right, top, bottom, top left, top right, bottom right, bottom left.

struct Direction {
  int dx;
  int dy;
};
inline constexpr std::array<Direction, 8> kDirections = {
    {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, 1}, {-1, -1}, {1, -1}}};

struct Penalties {
  uint8_t p1;
  std::array<uint8_t, 256> p2;  // by grey step g
};
// P2(g) = max(p1, min(p2, p2_min), p2 / (1 + slope * g)), the quotient rounded half up:
//   (2000 * p2 + 1000 + slope_permille * g) / (2 * (1000 + slope_permille * g)) in integers.
Penalties MakePenalties(const SgmSettings& settings);

// W x H x D cells of one byte; cell (x, y, i) at (y * W + x) * D + i.
struct CellVolume {
  uint8_t* cells;
  int width;
  int height;
  int disparities;

  uint8_t* At(int x, int y) const {
    return cells + (static_cast<size_t>(y) * width + x) * disparities;
  }
};

// How many lines a direction has; they can be computed independently. Horizontal: the rows.
// Otherwise a line starts in each column of the first row and enters again from the other side
// where it leaves the picture (as a new path), so that every line is as long as the picture is
// high.
int LineCount(Direction direction, int width, int height);

// Adds L along the lines [begin, end) of `direction` to `sums`. `scratch` keeps memory between
// calls; one per thread.
void AddPathCosts(Direction direction, int begin, int end, const CellVolume& costs,
                  const GreyImage& guide, const Penalties& penalties, std::vector<uint8_t>* scratch,
                  const CellVolume& sums);

}  // namespace vs
