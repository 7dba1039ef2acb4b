#include "engine/camera/camera_hub.h"

#include <algorithm>
#include <utility>

#include "engine/base/str.h"
#include "engine/camera/gvcp.h"
#include "engine/camera/shared_camera.h"

namespace vs {

Result<std::shared_ptr<CameraSource>> CameraHub::Acquire(const CameraUri& uri) {
  MutexLock lock(mutex_);
  std::erase_if(open_, [](const Open& open) { return open.camera.expired(); });
  const auto found = std::ranges::find_if(open_, [&uri](const Open& open) {
    return open.uri.scheme == uri.scheme && open.uri.address == uri.address;
  });
  if (found != open_.end()) {
    const std::shared_ptr<SharedCamera> shared = found->camera.lock();
    if (shared != nullptr && (uri.options.empty() || uri.options == found->uri.options)) {
      return shared->MakeHandle();
    }
    // Somebody only looks at the camera's features and will let go: make place for the real user.
    if (!found->uri.options.empty()) {
      return FailedPrecondition(Str("camera ", found->uri.ToString(),
                                    " is open; use it with the same options or stop its users "
                                    "before opening it as ",
                                    uri.ToString()));
    }
    open_.erase(found);
  }
  VS_ASSIGN_OR_RETURN(std::unique_ptr<CameraSource> camera, CameraDrivers::Get().Make(uri));
  if (camera->Recorded()) return std::shared_ptr<CameraSource>(std::move(camera));
  auto shared = std::make_shared<SharedCamera>(std::move(camera));
  open_.push_back({uri, shared});
  return shared->MakeHandle();
}

std::vector<CameraHub::Entry> CameraHub::List() const {
  std::vector<std::pair<CameraUri, std::shared_ptr<SharedCamera>>> open;
  {
    MutexLock lock(mutex_);
    for (const Open& entry : open_) {
      if (auto camera = entry.camera.lock()) open.emplace_back(entry.uri, std::move(camera));
    }
  }
  std::vector<Entry> entries;
  for (const auto& [uri, camera] : open)
    entries.push_back({uri.ToString(), camera->camera().Stats()});
  return entries;
}

Result<std::vector<FoundCamera>> CameraHub::Discover(std::chrono::milliseconds timeout) const {
  return DiscoverGevCameras(timeout);
}

}  // namespace vs
