#include "engine/camera/camera_hub.h"

#include <algorithm>
#include <thread>
#include <utility>

#include "engine/base/str.h"
#include "engine/camera/gvcp.h"
#include "engine/camera/shared_camera.h"

namespace vs {
namespace {

constexpr std::chrono::milliseconds kAskTime{150};

}  // namespace

class CameraHub::Closer {
 public:
  Closer() : thread_([this] { Run(); }) {}
  // Waits until all are closed.
  ~Closer() {
    {
      MutexLock lock(mutex_);
      quit_ = true;
      changed_.NotifyAll();
    }
    thread_.join();
  }
  Closer(const Closer&) = delete;
  Closer& operator=(const Closer&) = delete;

  void Close(std::unique_ptr<SharedCamera> camera) {
    MutexLock lock(mutex_);
    cameras_.push_back(std::move(camera));
    changed_.NotifyAll();
  }

 private:
  void Run() {
    while (true) {
      std::vector<std::unique_ptr<SharedCamera>> closing;  // destroyed after the lock is gone
      MutexLock lock(mutex_);
      while (cameras_.empty() && !quit_) changed_.Wait(mutex_);
      if (cameras_.empty()) return;
      closing.swap(cameras_);
    }
  }

  Mutex mutex_;
  CondVar changed_;
  std::vector<std::unique_ptr<SharedCamera>> cameras_ VS_GUARDED_BY(mutex_);
  bool quit_ VS_GUARDED_BY(mutex_) = false;
  std::thread thread_;
};

CameraHub::CameraHub() : closer_(std::make_shared<Closer>()) {}
CameraHub::~CameraHub() = default;

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
  const std::shared_ptr<SharedCamera> shared(
      new SharedCamera(std::move(camera)),
      [weak_closer = std::weak_ptr(closer_)](SharedCamera* unused) {
        std::unique_ptr<SharedCamera> closing(unused);
        if (const auto closer = weak_closer.lock()) closer->Close(std::move(closing));
      });
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
  for (const auto& [uri, camera] : open) {
    entries.push_back({uri.ToString(), camera->camera().Stats()});
  }
  return entries;
}

Result<std::vector<FoundCamera>> CameraHub::Discover(std::chrono::milliseconds timeout) const {
  VS_ASSIGN_OR_RETURN(std::vector<FoundCamera> cameras, DiscoverGevCameras(timeout));
  for (FoundCamera& camera : cameras) {
    const auto privilege = ReadGevRegister(camera.address, kGevControlPrivilege, kAskTime);
    camera.in_use = privilege && *privilege != 0;
  }
  return cameras;
}

}  // namespace vs
