#pragma once

#include <memory>
#include <optional>

#include "engine/image/depth_map.h"
#include "engine/image/disparity_map.h"
#include "engine/image/image.h"
#include "engine/image/pixel_rect.h"
#include "engine/image/rectification.h"
#include "engine/image/rectified_geometry.h"
#include "engine/stereo/sgm_settings.h"

namespace vs {

// What StereoMatcher::Process makes of a pair. With settings alone that is what Match does.
struct StereoPlan {
  // Null: the pictures are rectified already. A plan with the same object is the same plan.
  std::shared_ptr<const Rectification> rectification;
  // Of pictures that are rectified already, if it is known.
  std::optional<RectifiedGeometry> geometry;
  SgmSettings settings;
  // Of the rectified left picture, as MatchRegion takes it. Empty: all of it.
  std::optional<PixelRect> region;
  // Whether depth is wanted, too.
  bool depth = false;

  bool operator==(const StereoPlan&) const = default;
};

struct StereoResult {
  GreyImage left;          // rectified; the picture that was given if it was so already
  DisparityMap disparity;  // with the geometry, as far as it is known
  DepthMap depth;          // empty if not wanted
};

// Of the rectified pair that a plan makes of pictures of width x height px; only that size if the
// rest is not known.
inline RectifiedGeometry GeometryOf(const StereoPlan& plan, int width, int height) {
  if (plan.rectification != nullptr) return plan.rectification->geometry;
  return plan.geometry.value_or(RectifiedGeometry{.width = width, .height = height});
}

}  // namespace vs
