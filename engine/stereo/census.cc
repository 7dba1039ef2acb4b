#include "engine/stereo/census.h"

#include <cstddef>
#include <cstring>

namespace vs {
namespace {

void AddNeighbour(const uint8_t* __restrict centre, const uint8_t* __restrict neighbour, int width,
                  uint8_t bit, uint8_t* __restrict code) {
  for (int x = 0; x < width; ++x) {
    code[x] = static_cast<uint8_t>(code[x] | (neighbour[x] < centre[x] ? bit : 0));
  }
}

// Calls visit(dx, dy) for each neighbour of a box of +-rx, +-ry whose members lie `stride` apart.
template <class Visit>
void ForEachInBox(int rx, int ry, int stride, Visit visit) {
  for (int dy = -ry; dy <= ry; ++dy) {
    for (int dx = -rx; dx <= rx; ++dx) {
      if (dx != 0 || dy != 0) visit(dx * stride, dy * stride);
    }
  }
}

template <class Visit>
void ForEachNeighbour(CensusPattern pattern, Visit visit) {
  switch (pattern) {
    case CensusPattern::k5x5:
      return ForEachInBox(2, 2, 1, visit);
    case CensusPattern::k7x7:
      return ForEachInBox(3, 3, 1, visit);
    case CensusPattern::k9x7:
      return ForEachInBox(4, 3, 1, visit);
    case CensusPattern::kStrided3x3:
      for (int stride = 1; stride <= 3; ++stride) ForEachInBox(1, 1, stride, visit);
  }
}

}  // namespace

int CensusBytes(CensusPattern pattern) {
  switch (pattern) {
    case CensusPattern::k7x7:
      return 6;
    case CensusPattern::k9x7:
      return 8;
    default:
      return 3;
  }
}

int CensusShift(CensusPattern pattern) {
  return pattern == CensusPattern::k7x7 || pattern == CensusPattern::k9x7 ? 1 : 0;
}

int CensusSteps(CensusPattern pattern, ptrdiff_t stride, ptrdiff_t* steps) {
  int count = 0;
  ForEachNeighbour(pattern, [&](int dx, int dy) { steps[count++] = dy * stride + dx; });
  return count;
}

void CensusRow(const PaddedPicture& picture, CensusPattern pattern, int y, uint8_t* codes) {
  const int width = picture.width();
  std::memset(codes, 0, static_cast<size_t>(width) * CensusBytes(pattern));
  int count = 0;
  ForEachNeighbour(pattern, [&](int dx, int dy) {
    AddNeighbour(picture.Row(y), picture.Row(y + dy) + dx, width,
                 static_cast<uint8_t>(1 << (count & 7)),
                 codes + static_cast<size_t>(count >> 3) * width);
    ++count;
  });
}

}  // namespace vs
