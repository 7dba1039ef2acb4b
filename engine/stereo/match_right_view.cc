#include "engine/stereo/match_right_view.h"

#include <algorithm>

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
                                    const GreyImage& right, const SgmSettings& settings,
                                    int threads, BufferPool& pool) {
  VS_ASSIGN_OR_RETURN(DisparityMap map, matcher.Match(Mirrored(right, pool), Mirrored(left, pool),
                                                      settings, threads, pool));
  MirrorInPlace(&map.disparity);
  MirrorInPlace(&map.confidence);
  MirrorInPlace(&map.reason);
  return map;
}

}  // namespace vs
