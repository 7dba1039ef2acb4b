#include "server/sequences/camera_use.h"

#include <utility>
#include <variant>

#include "engine/base/str.h"

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

std::string CameraTrouble(const Run& run, const CameraHub& cameras) {
  const std::vector<CameraHub::Entry> open = cameras.List();
  if (open.empty()) return "";
  for (const CameraUse& use : CamerasOf(run, cameras)) {
    for (const CameraHub::Entry& entry : open) {
      const Result<CameraUri> uri = CameraUri::Parse(entry.uri);
      if (!uri || uri->scheme != use.camera.scheme || uri->address != use.camera.address) continue;
      const std::string trouble = TroubleOf(entry.stats);
      if (!trouble.empty()) {
        return Str(use.block, ": camera ", use.camera.ToString(), ": ", trouble);
      }
    }
  }
  return "";
}

}  // namespace vs
