#include "server/services/camera_service.h"

#include <algorithm>
#include <chrono>
#include <set>
#include <utility>

#include "engine/base/str.h"
#include "server/sequences/camera_use.h"
#include "server/services/periodic_source.h"

namespace vs {
namespace {

namespace pb = visionserver::v1;

constexpr uint32_t kMinSearchMs = 100;
constexpr uint32_t kMaxSearchMs = 10'000;
constexpr uint32_t kDefaultSearchMs = 1000;
constexpr int kMaxFeatures = 100;

// Options say how a camera is used, not which one it is.
bool SameCamera(const CameraUri& a, const CameraUri& b) {
  return a.scheme == b.scheme && a.address == b.address;
}

Status CheckCount(int count) {
  if (count >= 1 && count <= kMaxFeatures) return Status();
  return InvalidArgument(Str("name 1 to ", kMaxFeatures, " features at once, not ", count));
}

pb::DiscoveredCamera ToProto(const FoundCamera& found) {
  pb::DiscoveredCamera camera;
  camera.set_uri(found.uri);
  camera.set_vendor_model(found.model);
  camera.set_serial(found.serial);
  camera.set_address(found.address);
  camera.set_user_name(found.name);
  return camera;
}

}  // namespace

CameraService::CameraService(CameraHub& hub, SequenceManager& manager,
                             std::map<std::string, CameraUri> cameras, const Clock& clock)
    : hub_(hub),
      manager_(manager),
      cameras_(std::move(cameras)),
      observed_(clock, [this] { return Observe(); }) {}

void CameraService::Register(Router& router) {
  const std::string service = "/visionserver.v1.CameraService/";
  router.Unary(service + "ListCameras", this, &CameraService::ListCameras);
  router.Unary(service + "GetCamera", this, &CameraService::GetCamera);
  router.Stream(service + "WatchCameras", this, &CameraService::WatchCameras);
  // These wait for a camera.
  const MethodOptions slow{.lane = Lane::kSlow};
  router.Unary(service + "DiscoverCameras", this, &CameraService::DiscoverCameras, slow);
  router.Unary(service + "ListFeatures", this, &CameraService::ListFeatures, slow);
  router.Unary(service + "GetFeatures", this, &CameraService::GetFeatures, slow);
  router.Unary(service + "SetFeatures", this, &CameraService::SetFeatures, slow);
  router.Unary(service + "TriggerCamera", this, &CameraService::TriggerCamera, slow);
}

std::vector<CameraEntry> CameraService::Cameras() {
  struct Known {
    CameraUri uri;
    CameraEntry entry;
  };
  std::vector<Known> known;
  for (const auto& [id, uri] : cameras_) {
    known.push_back({uri, {.id = id, .uri = uri.ToString(), .stats = {}, .used_by = {}}});
  }
  const auto find = [&known](const CameraUri& uri) {
    return std::find_if(known.begin(), known.end(),
                        [&uri](const Known& one) { return SameCamera(one.uri, uri); });
  };
  for (const CameraHub::Entry& open : hub_.List()) {
    const Result<CameraUri> uri = CameraUri::Parse(open.uri);
    if (!uri) continue;
    auto place = find(*uri);
    if (place == known.end()) {
      const std::string id = CameraUri{uri->scheme, uri->address, {}}.ToString();
      place = known.insert(place, {*uri, {.id = id, .uri = open.uri, .stats = {}, .used_by = {}}});
    }
    place->entry.stats = open.stats;
  }
  for (const SequenceStatus& status : manager_.List()) {
    const std::shared_ptr<Run> run = manager_.FindRun(status.id);
    if (run == nullptr) continue;
    std::set<CameraEntry*> used;
    for (const CameraUse& use : CamerasOf(*run, hub_)) {
      if (const auto place = find(use.camera); place != known.end()) used.insert(&place->entry);
    }
    for (CameraEntry* entry : used) entry->used_by.push_back(status.id);
  }
  std::vector<CameraEntry> entries;
  entries.reserve(known.size());
  for (Known& one : known) entries.push_back(std::move(one.entry));
  std::sort(entries.begin(), entries.end(),
            [](const CameraEntry& a, const CameraEntry& b) { return a.id < b.id; });
  return entries;
}

Result<pb::ListCamerasResponse> CameraService::ListCameras(
    const Call& /*call*/, const pb::ListCamerasRequest& /*request*/) {
  pb::ListCamerasResponse response;
  for (const CameraEntry& entry : Cameras()) *response.add_cameras() = vs::ToProto(entry);
  return response;
}

Result<pb::Camera> CameraService::GetCamera(const Call& /*call*/,
                                            const pb::GetCameraRequest& request) {
  for (const CameraEntry& entry : Cameras()) {
    if (entry.id == request.id()) return vs::ToProto(entry);
  }
  return Find(request.id()).error();
}

Result<pb::DiscoverCamerasResponse> CameraService::DiscoverCameras(
    const Call& call, const pb::DiscoverCamerasRequest& request) {
  const uint32_t timeout_ms = request.timeout_ms() == 0 ? kDefaultSearchMs : request.timeout_ms();
  if (timeout_ms < kMinSearchMs || timeout_ms > kMaxSearchMs) {
    return InvalidArgument(
        Str("timeout_ms must be ", kMinSearchMs, " to ", kMaxSearchMs, ", or 0"));
  }
  VS_ASSIGN_OR_RETURN(const std::vector<FoundCamera> found,
                      hub_.Discover(std::chrono::milliseconds(timeout_ms), call.cancelled));
  const std::vector<CameraEntry> known = Cameras();
  pb::DiscoverCamerasResponse response;
  for (const FoundCamera& one : found) {
    pb::DiscoveredCamera* camera = response.add_cameras();
    *camera = ToProto(one);
    for (const CameraEntry& entry : known) {
      const Result<CameraUri> uri = CameraUri::Parse(entry.uri);
      const bool same = (!entry.stats.serial.empty() && entry.stats.serial == one.serial) ||
                        (uri && (uri->address == one.serial || uri->address == one.address));
      if (same) camera->set_known_as(entry.id);
    }
  }
  return response;
}

Result<pb::ListFeaturesResponse> CameraService::ListFeatures(
    const Call& /*call*/, const pb::ListFeaturesRequest& request) {
  VS_ASSIGN_OR_RETURN(const auto camera, Borrow(request.id()));
  VS_ASSIGN_OR_RETURN(const std::vector<FeatureInfo> features, camera->Features());
  pb::ListFeaturesResponse response;
  for (const FeatureInfo& info : features) *response.add_features() = vs::ToProto(info);
  return response;
}

Result<pb::GetFeaturesResponse> CameraService::GetFeatures(const Call& call,
                                                           const pb::GetFeaturesRequest& request) {
  VS_RETURN_IF_ERROR(CheckCount(request.names_size()));
  VS_ASSIGN_OR_RETURN(const auto camera, Borrow(request.id()));
  pb::GetFeaturesResponse response;
  for (const std::string& name : request.names()) {
    if (call.cancelled.stop_requested()) return Cancelled("nobody waits for the answer");
    VS_ASSIGN_OR_RETURN(const FeatureValue value, camera->GetFeature(name));
    *response.add_values() = vs::ToProto(name, value);
  }
  return response;
}

Result<pb::SetFeaturesResponse> CameraService::SetFeatures(const Call& call,
                                                           const pb::SetFeaturesRequest& request) {
  VS_RETURN_IF_ERROR(CheckCount(request.values_size()));
  VS_ASSIGN_OR_RETURN(const auto camera, Borrow(request.id()));
  pb::SetFeaturesResponse response;
  for (const pb::FeatureValue& wanted : request.values()) {
    if (call.cancelled.stop_requested()) return Cancelled("nobody waits for the answer");
    VS_ASSIGN_OR_RETURN(const FeatureValue value, FromProto(wanted));
    const Result<FeatureValue> read_back = camera->SetFeature(wanted.name(), value);
    if (!read_back) {
      return read_back.error().Annotated(Str(response.values_size(), " of ", request.values_size(),
                                             " features were set, then ", wanted.name()));
    }
    *response.add_values() = vs::ToProto(wanted.name(), *read_back);
  }
  return response;
}

Result<pb::TriggerCameraResponse> CameraService::TriggerCamera(
    const Call& /*call*/, const pb::TriggerCameraRequest& request) {
  VS_ASSIGN_OR_RETURN(const auto camera, Borrow(request.id()));
  VS_RETURN_IF_ERROR(camera->Trigger());
  return pb::TriggerCameraResponse();
}

Result<std::unique_ptr<StreamSource>> CameraService::WatchCameras(
    const Call& /*call*/, const pb::WatchCamerasRequest& request) {
  return PeriodicSource::Make(observed_, {.interval_ms = request.interval_ms()});
}

SharedObservations::List CameraService::Observe() {
  Observation all;
  pb::WatchCamerasResponse response;
  for (const CameraEntry& entry : Cameras()) {
    all.changes +=
        Str(entry.id, ' ', static_cast<int>(entry.stats.state), ' ', entry.stats.last_error, '\n');
    *response.add_cameras() = vs::ToProto(entry);
  }
  all.message = Serialize(response);
  return {std::move(all)};
}

Result<CameraUri> CameraService::Find(const std::string& id) {
  const auto named = cameras_.find(id);
  if (named != cameras_.end()) return named->second;
  std::string names;
  for (const CameraEntry& entry : Cameras()) {
    if (entry.id == id) return CameraUri::Parse(entry.uri);
    names += (names.empty() ? "" : ", ") + entry.id;
  }
  return NotFound(Str("there is no camera ", Quoted(id),
                      "; there are: ", names.empty() ? "none" : names.substr(0, 500)));
}

Result<std::shared_ptr<CameraSource>> CameraService::Borrow(const std::string& id) {
  VS_ASSIGN_OR_RETURN(CameraUri uri, Find(id));
  uri.options.clear();
  return hub_.Acquire(uri);
}

}  // namespace vs
