#pragma once

#include <chrono>
#include <map>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include "engine/base/host_folders.h"
#include "engine/base/mutex.h"
#include "engine/base/status.h"
#include "engine/camera/camera_source.h"
#include "engine/camera/gvcp.h"

namespace vs {

class SharedCamera;

// The open cameras of the whole server. One physical camera is opened once and shared: by the
// sequences that use its pictures and by the camera API. Thread-safe.
class CameraHub {
 public:
  struct Entry {
    std::string uri;
    CameraStats stats;
  };

  // `folders`: where cameras of the scheme "file" may have their pictures (see PicturePath).
  explicit CameraHub(HostFolders folders = {});
  ~CameraHub();  // waits until the cameras that were let go are closed

  // From now on "camera:NAME" means this camera, with its options. INVALID_ARGUMENT when the name
  // is taken or its pictures lie outside the allowed folders.
  Status Name(const std::string& name, const CameraUri& uri);
  // The camera that "camera:NAME" means, any other URI as it is. NOT_FOUND names the cameras that
  // there are.
  Result<CameraUri> Resolve(const CameraUri& uri) const;

  // The camera of this URI (see Resolve), opened when the first user needs it and closed when the
  // last one lets go. Each user has its own Start and Stop; all see the same pictures. A URI
  // without options also means a camera that is open with options. Errors: NOT_FOUND (no such
  // driver), INVALID_ARGUMENT (bad options or folder), FAILED_PRECONDITION (already open with other
  // options). Recorded sources are not shared: each user reads the files from the start.
  Result<std::shared_ptr<CameraSource>> Acquire(const CameraUri& uri);

  // The cameras that somebody uses now.
  std::vector<Entry> List() const;

  // Asks all networks for cameras; takes as long as `timeout`, or until `cancelled` stops.
  Result<std::vector<FoundCamera>> Discover(std::chrono::milliseconds timeout,
                                            const std::stop_token& cancelled = {}) const;

 private:
  class Closer;
  struct Open {
    CameraUri uri;
    std::weak_ptr<SharedCamera> camera;
  };

  // A folder of pictures as an absolute path, any other URI as it is.
  Result<CameraUri> Located(const CameraUri& uri) const;

  const HostFolders folders_;
  // Cameras are closed in the background: one that does not answer takes seconds.
  const std::shared_ptr<Closer> closer_;
  mutable Mutex mutex_;
  std::vector<Open> open_ VS_GUARDED_BY(mutex_);
  std::map<std::string, CameraUri> names_ VS_GUARDED_BY(mutex_);
};

}  // namespace vs
