#include "engine/stereo/refine.h"

#include <algorithm>
#include <utility>

#include "engine/stereo/background_fill.h"
#include "engine/stereo/gated_filter.h"
#include "engine/stereo/median_filter.h"
#include "engine/stereo/speckle_filter.h"

namespace vs {

DisparityMap MakeDisparityMap(int width, int height, int offset_px, BufferPool& pool) {
  DisparityMap map{.disparity = Image<uint16_t>(pool, width, height),
                   .confidence = GreyImage(pool, width, height),
                   .reason = GreyImage(pool, width, height),
                   .offset_px = offset_px};
  map.geometry.width = width;
  map.geometry.height = height;
  return map;
}

void Refiner::Refine(const GreyImage& left, const SgmSettings& settings, int parts,
                     ThreadTeam* team, BufferPool& pool, DisparityMap* map) {
  scratch_.resize(std::max(scratch_.size(), static_cast<size_t>(parts)));
  const int height = left.height();
  const auto for_rows = [&](auto filter) {
    team->Run(parts, [&](int part) {
      const RowRange rows = ShareOf(height, part, parts);
      filter(part, rows.begin, rows.end);
    });
  };
  DisparityMap other = MakeDisparityMap(left.width(), height, map->offset_px, pool);
  if (settings.median > 0) {
    for_rows([&](int part, int begin, int end) {
      MedianFilterRows(*map, settings.median, begin, end, &scratch_[part].median, &other, kernels_);
    });
    std::swap(*map, other);
  }
  if (settings.speckle_size > 0) {
    RemoveSpeckles(settings.speckle_size, kDisparityScale * settings.speckle_step, pool, map);
  }
  if (settings.gated_median || settings.fill_holes) {
    const GatedFilterOptions options{
        .gate = settings.gate, .median = settings.gated_median, .fill = settings.fill_holes};
    for_rows([&](int part, int begin, int end) {
      GatedFilterRows(*map, left, options, begin, end, &scratch_[part].gated, &other, kernels_);
    });
    std::swap(*map, other);
  }
  if (settings.fill_background) {
    for_rows([&](int, int begin, int end) { FillBackgroundRows(begin, end, map); });
  }
}

}  // namespace vs
