#include "engine/stereo/path_cost.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>

namespace vs {
namespace {

// Stands for a neighbouring disparity that does not exist: not less than any P2.
constexpr uint8_t kGuard = 127;

// One pixel of a path. `path` is L of the pixel before, with a guard on each side of its
// `disparities` values, and becomes L of this pixel.
void Step(const uint8_t* __restrict cost, int disparities, uint8_t p1, uint8_t p2,
          uint8_t* __restrict path, uint8_t* __restrict total, uint8_t* __restrict sum) {
  uint8_t least = 255;
  for (int i = 0; i < disparities; ++i) {
    const auto near = static_cast<uint8_t>(std::min(path[i - 1], path[i + 1]) + p1);
    const uint8_t best = std::min(std::min(path[i], near), p2);
    total[i] = static_cast<uint8_t>(cost[i] + best);
    least = std::min(least, total[i]);
  }
  for (int i = 0; i < disparities; ++i) {
    path[i] = static_cast<uint8_t>(total[i] - least);
    sum[i] = static_cast<uint8_t>(sum[i] + std::min<uint8_t>(path[i], 255 - sum[i]));
  }
}

// The paths of some lines: L of each line's latest pixel, and room for one T.
class Paths {
 public:
  Paths(int lines, int disparities, std::vector<uint8_t>* memory)
      : disparities_(disparities), stride_(static_cast<size_t>(disparities) + 2) {
    memory->assign(stride_ * lines + disparities, kGuard);
    paths_ = memory->data() + 1;
    total_ = memory->data() + stride_ * lines;
  }
  // Without a pixel before: L = 0 makes T = C.
  void Restart(int line) { std::memset(Line(line), 0, static_cast<size_t>(disparities_)); }
  void Advance(int line, const uint8_t* cost, uint8_t p1, uint8_t p2, uint8_t* sum) {
    Step(cost, disparities_, p1, p2, Line(line), total_, sum);
  }

 private:
  uint8_t* Line(int line) { return paths_ + stride_ * line; }

  int disparities_;
  size_t stride_;
  uint8_t* paths_;
  uint8_t* total_;
};

void AddHorizontal(int dx, int begin, int end, const CellVolume& costs, const GreyImage& guide,
                   const Penalties& penalties, std::vector<uint8_t>* scratch,
                   const CellVolume& sums) {
  Paths path(1, costs.disparities, scratch);
  const int first = dx > 0 ? 0 : costs.width - 1;
  for (int y = begin; y < end; ++y) {
    const uint8_t* grey = guide.Row(y);
    path.Restart(0);
    for (int n = 0, x = first; n < costs.width; ++n, x += dx) {
      const int before = n == 0 ? x : x - dx;
      path.Advance(0, costs.At(x, y), penalties.p1, penalties.p2[std::abs(grey[x] - grey[before])],
                   sums.At(x, y));
    }
  }
}

void AddVertical(Direction direction, int begin, int end, const CellVolume& costs,
                 const GreyImage& guide, const Penalties& penalties, std::vector<uint8_t>* scratch,
                 const CellVolume& sums) {
  Paths paths(end - begin, costs.disparities, scratch);
  const int width = costs.width;
  const int entry = direction.dx > 0 ? 0 : width - 1;  // the column where a line comes in again
  for (int n = 0; n < costs.height; ++n) {
    const int y = direction.dy > 0 ? n : costs.height - 1 - n;
    const uint8_t* grey = guide.Row(y);
    const uint8_t* grey_before = n == 0 ? grey : guide.Row(y - direction.dy);
    const int shift = direction.dx * n % width;
    for (int line = begin; line < end; ++line) {
      const int x = (line + shift + width) % width;
      const bool starts = n == 0 || (direction.dx != 0 && x == entry);
      if (starts) paths.Restart(line - begin);
      const int step = starts ? 0 : std::abs(grey[x] - grey_before[x - direction.dx]);
      paths.Advance(line - begin, costs.At(x, y), penalties.p1, penalties.p2[step], sums.At(x, y));
    }
  }
}

}  // namespace

Penalties MakePenalties(const SgmSettings& settings) {
  Penalties penalties{};
  penalties.p1 = static_cast<uint8_t>(settings.p1);
  for (int g = 0; g < 256; ++g) {
    const int divisor = 1000 + settings.p2_slope_permille * g;
    const int falling = (2000 * settings.p2 + divisor) / (2 * divisor);
    const int floor = std::max(settings.p1, std::min(settings.p2, settings.p2_min));
    penalties.p2[g] = static_cast<uint8_t>(std::max(floor, falling));
  }
  return penalties;
}

int LineCount(Direction direction, int width, int height) {
  return direction.dy == 0 ? height : width;
}

void AddPathCosts(Direction direction, int begin, int end, const CellVolume& costs,
                  const GreyImage& guide, const Penalties& penalties, std::vector<uint8_t>* scratch,
                  const CellVolume& sums) {
  if (direction.dy == 0) {
    AddHorizontal(direction.dx, begin, end, costs, guide, penalties, scratch, sums);
  } else {
    AddVertical(direction, begin, end, costs, guide, penalties, scratch, sums);
  }
}

}  // namespace vs
