#include "engine/stereo/match_right_view.h"

#include <algorithm>

#include "engine/stereo/match_region.h"

namespace vs {
namespace {

template <class T>
void MirrorInPlace(Image<T>* image) {
  for (int y = 0; y < image->height(); ++y) {
    std::reverse(image->Row(y), image->Row(y) + image->width());
  }
}

GreyImage Mirrored(const GreyImage& image, BufferPool& pool) {
  GreyImage mirrored(pool, image.width(), image.height());
  for (int y = 0; y < image.height(); ++y) {
    std::reverse_copy(image.Row(y), image.Row(y) + image.width(), mirrored.Row(y));
  }
  return mirrored;
}

}  // namespace

Result<DisparityMap> MatchRightView(StereoMatcher& matcher, const GreyImage& left,
                                    const GreyImage& right, const PixelRect& region,
                                    const SgmSettings& settings, int threads, BufferPool& pool) {
  PixelRect mirrored = Inside(region, right.width(), right.height());
  mirrored.x = right.width() - mirrored.x - mirrored.width;
  VS_ASSIGN_OR_RETURN(DisparityMap map,
                      MatchRegion(matcher, Mirrored(right, pool), Mirrored(left, pool), mirrored,
                                  settings, threads, pool));
  MirrorInPlace(&map.disparity);
  MirrorInPlace(&map.confidence);
  MirrorInPlace(&map.reason);
  return map;
}

}  // namespace vs
