// The plain matcher: each stage as its header defines it, one after the other over the whole
// picture. It is the measure of the fast backends, so clarity goes before speed. It keeps two bytes
// for each pixel and disparity (80 MB at 648 x 483 with 128) from picture to picture.
#include <algorithm>
#include <cstddef>
#include <memory>
#include <vector>

#include "engine/base/str.h"
#include "engine/stereo/cell_memory.h"
#include "engine/stereo/condition_pair.h"
#include "engine/stereo/cost_window.h"
#include "engine/stereo/path_cost.h"
#include "engine/stereo/refine.h"
#include "engine/stereo/selection.h"
#include "engine/stereo/stereo_matcher.h"
#include "engine/stereo/thread_team.h"

namespace vs {
namespace {

class ReferenceMatcher final : public StereoMatcher {
 public:
  size_t WorkingBytes() const override { return costs_.Bytes() + sums_.Bytes(); }

 private:
  struct Worker {
    CostRows cost_rows;
    Selection selection;
    std::vector<uint8_t> paths;
  };

  Result<DisparityMap> MatchPair(const GreyImage& raw_left, const GreyImage& raw_right,
                                 const SgmSettings& settings, int threads,
                                 BufferPool& pool) override {
    const PicturePair pair = ConditionPair(raw_left, raw_right, settings, pool);
    const GreyImage& left = pair.left;
    const GreyImage& right = pair.right;
    const int width = left.width();
    const int height = left.height();
    parts_ = std::clamp(threads, 1, std::min(width, height));
    workers_.resize(std::max(workers_.size(), static_cast<size_t>(parts_)));

    const size_t cells = static_cast<size_t>(width) * height * settings.num_disparities;
    const CellVolume costs{costs_.Reserve(cells), width, height, settings.num_disparities};
    const CellVolume sums{sums_.Reserve(cells), width, height, settings.num_disparities};
    if (costs.cells == nullptr || sums.cells == nullptr) {
      return ResourceExhausted(Str("matcher: not enough memory for two volumes of ",
                                   cells / 1000000,
                                   " MB; use smaller pictures or a smaller range"));
    }
    ComputeCosts(left, right, settings, costs);
    SumPaths(left, settings, costs, sums);
    DisparityMap map = MakeDisparityMap(width, height, DisparityOffset(settings), pool);
    ForRows(height, [&](Worker& worker, int begin, int end) {
      worker.selection.Prepare(settings, width);
      for (int y = begin; y < end; ++y) worker.selection.Row(sums, left, y, &map);
    });
    refiner_.Refine(left, settings, parts_, &team_, pool, &map);
    return map;
  }

  // Calls work(worker, begin, end) for each part's share of `count` rows or lines.
  template <class Work>
  void ForRows(int count, Work work) {
    team_.Run(parts_, [&](int part) {
      const RowRange rows = ShareOf(count, part, parts_);
      work(workers_[part], rows.begin, rows.end);
    });
  }

  void ComputeCosts(const GreyImage& left, const GreyImage& right, const SgmSettings& settings,
                    const CellVolume& costs) {
    left_.Assign(left, settings.sobel_cap);
    right_.Assign(right, settings.sobel_cap);
    ForRows(costs.height, [&](Worker& worker, int begin, int end) {
      worker.cost_rows.Prepare(&left_, &right_, &left, settings);
      for (int y = begin; y < end; ++y) worker.cost_rows.Row(y, costs.At(0, y));
    });
  }

  void SumPaths(const GreyImage& left, const SgmSettings& settings, const CellVolume& costs,
                const CellVolume& sums) {
    const Penalties penalties = MakePenalties(settings);
    ForRows(sums.height, [&](Worker&, int begin, int end) {
      std::fill(sums.At(0, begin), sums.At(0, end), uint8_t{0});
    });
    for (int k = 0; k < settings.directions; ++k) {
      const Direction direction = kDirections[k];
      ForRows(LineCount(direction, sums.width, sums.height),
              [&](Worker& worker, int begin, int end) {
                AddPathCosts(direction, begin, end, costs, left, penalties, &worker.paths, sums);
              });
    }
  }

  ThreadTeam team_;
  int parts_ = 1;
  std::vector<Worker> workers_;
  PaddedPicture left_;
  PaddedPicture right_;
  Refiner refiner_;
  CellMemory costs_;
  CellMemory sums_;
};

VS_REGISTER_MATCHER("reference", 0, [] {
  return Result<std::unique_ptr<StereoMatcher>>(std::make_unique<ReferenceMatcher>());
});

}  // namespace
}  // namespace vs
