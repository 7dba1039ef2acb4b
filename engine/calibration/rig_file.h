#pragma once

#include <filesystem>

#include "engine/base/status.h"
#include "engine/image/stereo_rig.h"

namespace vs {

// NOT_FOUND, PERMISSION_DENIED, or as ParseRig (rig_json.h); the message begins with the path.
Result<StereoRig> LoadRig(const std::filesystem::path& path);
// Replaces the file in one step: after a crash there is the old file or the new one, whole. An
// invalid rig is not written.
Status SaveRig(const StereoRig& rig, const std::filesystem::path& path);

}  // namespace vs
