#include "engine/stereo/match_region.h"

#include <algorithm>
#include <cstring>

#include "engine/base/str.h"
#include "engine/stereo/refine.h"

namespace vs {
namespace {

GreyImage Crop(const GreyImage& picture, const PixelRect& part, BufferPool& pool) {
  GreyImage crop(pool, part.width, part.height);
  for (int y = 0; y < part.height; ++y) {
    std::memcpy(crop.Row(y), picture.Row(part.y + y) + part.x, static_cast<size_t>(part.width));
  }
  return crop;
}

template <class T>
void Paste(const Image<T>& from, const PixelRect& part, const PixelRect& region, T outside,
           Image<T>* to) {
  to->Fill(outside);
  for (int y = region.y; y < region.y + region.height; ++y) {
    std::memcpy(to->Row(y) + region.x, from.Row(y - part.y) + (region.x - part.x),
                static_cast<size_t>(region.width) * sizeof(T));
  }
}

}  // namespace

Result<DisparityMap> MatchRegion(StereoMatcher& matcher, const GreyImage& left,
                                 const GreyImage& right, const PixelRect& region,
                                 const SgmSettings& settings, int threads, BufferPool& pool) {
  const int width = left.width();
  const int height = left.height();
  const PixelRect inside = Inside(region, width, height);
  if (inside == PixelRect{0, 0, width, height}) {
    return matcher.Match(left, right, settings, threads, pool);
  }
  VS_RETURN_IF_ERROR(ValidateSettings(settings));
  VS_RETURN_IF_ERROR(ValidatePair(left, right));
  if (inside.width == 0 || inside.height == 0) {
    return InvalidArgument(Str("matcher: the region at ", region.x, ", ", region.y,
                               " lies outside the picture of ", width, " x ", height,
                               " px; move it inside, or set its size to 0 for all"));
  }
  const int nearest = settings.min_disparity + settings.num_disparities - 1;
  const int from_x = inside.x - kRegionContext - std::max(nearest, 0);
  const int to_x = inside.x + inside.width + kRegionContext - std::min(settings.min_disparity, 0);
  const PixelRect part =
      Inside({from_x, inside.y - kRegionContext, to_x - from_x, inside.height + 2 * kRegionContext},
             width, height);
  VS_ASSIGN_OR_RETURN(
      const DisparityMap found,
      matcher.Match(Crop(left, part, pool), Crop(right, part, pool), settings, threads, pool));
  DisparityMap map = MakeDisparityMap(width, height, found.offset_px, pool);
  Paste(found.disparity, part, inside, kInvalidDisparity, &map.disparity);
  Paste(found.confidence, part, inside, uint8_t{0}, &map.confidence);
  Paste(found.reason, part, inside, static_cast<uint8_t>(InvalidReason::kMasked), &map.reason);
  return map;
}

}  // namespace vs
