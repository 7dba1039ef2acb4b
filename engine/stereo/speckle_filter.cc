#include "engine/stereo/speckle_filter.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>

#include "engine/image/image.h"

namespace vs {
namespace {

// A run is a piece of a row in which each pixel is connected to the one before it. Regions are
// trees of runs (union-find): each run names another of its region, the root names itself. The
// earlier run becomes the root, so that a run never names a later one. Begin and end count pixels
// from the first one of the picture.
class Runs {
 public:
  Runs(int width, int height, BufferPool& pool)
      : begins_(pool, width, height),
        ends_(pool, width, height),
        parents_(pool, width, height),
        sizes_(pool, width, height) {}

  int32_t count() const { return count_; }
  int32_t begin(int32_t run) const { return begins_.Row(0)[run]; }
  int32_t end(int32_t run) const { return ends_.Row(0)[run]; }

  void Add(int begin, int end) {
    begins_.Row(0)[count_] = begin;
    ends_.Row(0)[count_] = end;
    sizes_.Row(0)[count_] = end - begin;
    parents_.Row(0)[count_] = count_;
    ++count_;
  }
  int32_t Root(int32_t run) {
    int32_t* parents = parents_.Row(0);
    while (parents[run] != run) {
      parents[run] = parents[parents[run]];
      run = parents[run];
    }
    return run;
  }
  void Join(int32_t a, int32_t b) {
    const int32_t root = std::min(a, b);
    const int32_t other = std::max(a, b);
    parents_.Row(0)[other] = root;
    sizes_.Row(0)[root] += sizes_.Row(0)[other];
  }
  // Pixels of the region with this root.
  int32_t Size(int32_t root) const { return sizes_.Row(0)[root]; }

 private:
  Image<int32_t> begins_;
  Image<int32_t> ends_;
  Image<int32_t> parents_;
  Image<int32_t> sizes_;
  int32_t count_ = 0;
};

bool Connected(uint16_t a, uint16_t b, int max_step) {
  return a != kInvalidDisparity && b != kInvalidDisparity && std::abs(a - b) <= max_step;
}

// Adds the runs of a row whose first pixel is the picture's pixel `origin`.
void AddRuns(const uint16_t* row, int width, int32_t origin, int max_step, Runs* runs) {
  for (int x = 0; x < width;) {
    if (row[x] == kInvalidDisparity) {
      ++x;
      continue;
    }
    const int begin = x++;
    while (x < width && Connected(row[x], row[x - 1], max_step)) ++x;
    runs->Add(origin + begin, origin + x);
  }
}

// Joins the runs [first, count) of `row` with those of the row above, [above_first, first).
void JoinRows(const uint16_t* row, const uint16_t* above, int width, int32_t origin, int max_step,
              int32_t above_first, int32_t first, Runs* runs) {
  int32_t upper = above_first;
  for (int32_t run = first; run < runs->count(); ++run) {
    const int begin = runs->begin(run) - origin;
    const int end = runs->end(run) - origin;
    const auto above_begin = [&](int32_t other) { return runs->begin(other) - (origin - width); };
    const auto above_end = [&](int32_t other) { return runs->end(other) - (origin - width); };
    while (upper < first && above_end(upper) <= begin) ++upper;
    for (int32_t other = upper; other < first && above_begin(other) < end; ++other) {
      const int32_t root = runs->Root(run);
      const int32_t other_root = runs->Root(other);
      if (root == other_root) continue;
      const int last = std::min(end, above_end(other));
      int x = std::max(begin, above_begin(other));
      while (x < last && !Connected(row[x], above[x], max_step)) ++x;
      if (x < last) runs->Join(root, other_root);
    }
  }
}

}  // namespace

void RemoveSpeckles(int max_size, int max_step, BufferPool& pool, DisparityMap* map) {
  const int width = map->disparity.width();
  const int height = map->disparity.height();
  Runs runs(width, height, pool);
  int32_t above_first = 0;
  for (int y = 0; y < height; ++y) {
    const int32_t first = runs.count();
    const uint16_t* row = map->disparity.Row(y);
    AddRuns(row, width, y * width, max_step, &runs);
    if (y > 0) {
      JoinRows(row, map->disparity.Row(y - 1), width, y * width, max_step, above_first, first,
               &runs);
    }
    above_first = first;
  }
  for (int32_t run = 0; run < runs.count(); ++run) {
    if (runs.Size(runs.Root(run)) > max_size) continue;
    const int y = runs.begin(run) / width;
    const int x = runs.begin(run) % width;
    const auto count = static_cast<size_t>(runs.end(run) - runs.begin(run));
    std::fill_n(map->disparity.Row(y) + x, count, kInvalidDisparity);
    std::fill_n(map->confidence.Row(y) + x, count, uint8_t{0});
    std::fill_n(map->reason.Row(y) + x, count, static_cast<uint8_t>(InvalidReason::kSpeckle));
  }
}

}  // namespace vs
