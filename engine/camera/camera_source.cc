#include "engine/camera/camera_source.h"

#include <array>

#include "engine/base/check.h"
#include "engine/base/str.h"

namespace vs {
namespace {

int64_t Count(uint64_t count) { return static_cast<int64_t>(count); }

}  // namespace

std::string_view CameraStateName(CameraState state) {
  static constexpr std::array<std::string_view, 6> kNames = {"closed",    "opening", "idle",
                                                             "streaming", "stalled", "lost"};
  const auto index = static_cast<size_t>(state);
  return index < kNames.size() ? kNames[index] : "unknown";
}

SourceReport ReportOf(const CameraStats& stats) {
  SourceReport report;
  report.problem = stats.last_error;
  const bool silent = stats.state == CameraState::kStalled || stats.state == CameraState::kLost;
  if (report.problem.empty() && silent) report.problem = "no pictures come";
  report.readings = {{"frames", Count(stats.frames)},
                     {"incomplete", Count(stats.incomplete)},
                     {"lost", Count(stats.lost)}};
  return report;
}

CameraDrivers& CameraDrivers::Get() {
  static CameraDrivers drivers;
  return drivers;
}

bool CameraDrivers::Add(std::string scheme, CameraFactory factory) {
  const bool added = factories_.emplace(std::move(scheme), std::move(factory)).second;
  VS_CHECK(added);
  return added;
}

std::vector<std::string> CameraDrivers::Schemes() const {
  std::vector<std::string> schemes;
  for (const auto& [scheme, factory] : factories_) schemes.push_back(scheme);
  return schemes;
}

Result<std::unique_ptr<CameraSource>> CameraDrivers::Make(const CameraUri& uri) const {
  const auto found = factories_.find(uri.scheme);
  if (found != factories_.end()) return found->second(uri);
  std::string schemes;
  for (const auto& [scheme, factory] : factories_) {
    schemes += (schemes.empty() ? "" : ", ") + scheme + ":";
  }
  return NotFound(Str("no camera driver for \"", uri.ToString(), "\": there are ", schemes));
}

}  // namespace vs
