#pragma once

#include <memory>
#include <string>

#include "engine/base/clock.h"
#include "engine/base/host_folders.h"
#include "engine/base/status.h"
#include "engine/image/stereo_rig.h"

namespace vs {

class CameraHub;   // engine/camera
class ResultSink;  // engine/core/result_sink.h
class TopicHub;    // engine/core/topic.h

// Finds a stored calibration by its name. Thread-safe.
class RigStore {
 public:
  virtual ~RigStore() = default;
  // NOT_FOUND names the rigs that there are.
  virtual Result<std::shared_ptr<const StereoRig>> Find(const std::string& name) const = 0;
};

// What a running block may reach outside its ports. The server fills it in; whoever runs a
// sequence without a server leaves the rest null, and a block that needs it fails to start with
// FAILED_PRECONDITION.
struct Environment {
  const Clock* clock = nullptr;  // never null
  CameraHub* cameras = nullptr;
  const RigStore* rigs = nullptr;
  TopicHub* topics = nullptr;
  ResultSink* results = nullptr;
  HostFolders folders;  // where blocks may read and, below the data folder, write
};

}  // namespace vs
