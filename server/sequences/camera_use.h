#pragma once

#include <string>
#include <vector>

#include "engine/camera/camera_hub.h"
#include "engine/core/run.h"

namespace vs {

// A camera that a block of a run takes pictures from.
struct CameraUse {
  std::string block;
  CameraUri camera;  // without options: which one, not how it is set
};

// By the parameters that are a camera's address, in the order of the blocks.
std::vector<CameraUse> CamerasOf(const Run& run, const CameraHub& cameras);

// Why no pictures come from a camera that should stream; empty when they come, or are just about
// to.
std::string TroubleOf(const CameraStats& stats);

}  // namespace vs
