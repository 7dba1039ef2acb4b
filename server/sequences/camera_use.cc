#include "server/sequences/camera_use.h"

#include <utility>
#include <variant>

namespace vs {

std::vector<CameraUse> CamerasOf(const Run& run, const CameraHub& cameras) {
  std::vector<CameraUse> uses;
  for (const ParamAssignment& one : run.Parameters()) {
    const auto* text = std::get_if<std::string>(&one.value);
    if (text == nullptr) continue;
    Result<CameraUri> uri = CameraUri::Parse(*text).and_then(
        [&cameras](const CameraUri& parsed) { return cameras.Resolve(parsed); });
    if (!uri) continue;
    uri->options.clear();
    uses.push_back({one.block, std::move(*uri)});
  }
  return uses;
}

std::string TroubleOf(const CameraStats& stats) {
  switch (stats.state) {
    case CameraState::kStalled:
    case CameraState::kLost:
      return stats.last_error.empty() ? "no pictures come" : stats.last_error;
    case CameraState::kOpening:
      return stats.last_error;
    default:
      return "";
  }
}

}  // namespace vs
