#include "engine/image/disparity_map.h"

#include <array>

namespace vs {

std::string_view InvalidReasonName(InvalidReason reason) {
  static constexpr std::array<std::string_view, kInvalidReasonCount> kNames = {
      "valid",     "occluded", "low texture", "ambiguous", "too near", "too far",
      "saturated", "dark",     "border",      "speckle",   "masked",   "filtered"};
  const auto index = static_cast<size_t>(reason);
  return index < kNames.size() ? kNames[index] : "unknown";
}

}  // namespace vs
