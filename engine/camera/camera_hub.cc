#include "engine/camera/camera_hub.h"

#include <algorithm>
#include <atomic>
#include <thread>
#include <utility>

#include "engine/base/str.h"
#include "engine/camera/gvcp.h"
#include "engine/camera/shared_camera.h"

namespace vs {
namespace {

constexpr std::string_view kNamedScheme = "camera";
constexpr std::string_view kFolderScheme = "file";

}  // namespace

// Destroys cameras in the background, each on a thread of its own.
class CameraHub::Closer {
 public:
  Closer() = default;
  // Waits until all are closed.
  ~Closer() { Reap(true); }
  Closer(const Closer&) = delete;
  Closer& operator=(const Closer&) = delete;

  void Close(std::unique_ptr<SharedCamera> camera) {
    Reap(false);
    auto done = std::make_shared<std::atomic<bool>>(false);
    std::thread thread([done, camera = std::move(camera)]() mutable {
      camera.reset();
      *done = true;
    });
    MutexLock lock(mutex_);
    closing_.push_back({std::move(thread), std::move(done)});
  }

 private:
  struct Closing {
    std::thread thread;
    std::shared_ptr<std::atomic<bool>> done;
  };

  void Reap(bool all) {
    std::vector<Closing> ended;
    {
      MutexLock lock(mutex_);
      for (size_t i = closing_.size(); i-- > 0;) {
        if (!all && !*closing_[i].done) continue;
        ended.push_back(std::move(closing_[i]));
        closing_.erase(closing_.begin() + static_cast<std::ptrdiff_t>(i));
      }
    }
    for (Closing& closing : ended) closing.thread.join();
  }

  Mutex mutex_;
  std::vector<Closing> closing_ VS_GUARDED_BY(mutex_);
};

CameraHub::CameraHub(HostFolders folders)
    : folders_(std::move(folders)), closer_(std::make_shared<Closer>()) {}
CameraHub::~CameraHub() = default;

Status CameraHub::Name(const std::string& name, const CameraUri& uri) {
  if (const auto located = Located(uri); !located) return located.error();
  MutexLock lock(mutex_);
  if (names_.try_emplace(name, uri).second) return Status();
  return InvalidArgument(Str("two cameras are called ", Quoted(name)));
}

Result<CameraUri> CameraHub::Resolve(const CameraUri& uri) const {
  if (uri.scheme != kNamedScheme) return uri;
  MutexLock lock(mutex_);
  const auto found = names_.find(uri.address);
  if (found != names_.end()) return found->second;
  std::string names;
  for (const auto& [name, named] : names_) names += (names.empty() ? "" : ", ") + name;
  return NotFound(Str("there is no camera called ", Quoted(uri.address),
                      "; there are: ", names.empty() ? "none" : names));
}

Result<CameraUri> CameraHub::Located(const CameraUri& uri) const {
  if (uri.scheme != kFolderScheme) return uri;
  VS_ASSIGN_OR_RETURN(const std::filesystem::path folder, PicturePath(folders_, uri.address));
  CameraUri located = uri;
  located.address = folder.string();
  return located;
}

Result<std::shared_ptr<CameraSource>> CameraHub::Acquire(const CameraUri& asked) {
  VS_ASSIGN_OR_RETURN(const CameraUri named, Resolve(asked));
  VS_ASSIGN_OR_RETURN(const CameraUri uri, Located(named));
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
  entries.reserve(open.size());
  for (const auto& [uri, camera] : open) {
    entries.push_back({uri.ToString(), camera->camera().Stats()});
  }
  return entries;
}

Result<std::vector<FoundCamera>> CameraHub::Discover(std::chrono::milliseconds timeout,
                                                     const std::stop_token& cancelled) const {
  return DiscoverGevCameras(timeout, "", cancelled);
}

}  // namespace vs
