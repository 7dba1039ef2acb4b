#include "server/vision.h"

#include <map>
#include <string>
#include <thread>
#include <utility>

namespace vs {
namespace {

// Those of the configuration, by id; their features are options of the URI.
Result<std::map<std::string, CameraUri>> CamerasOf(const config::ServerConfig& config) {
  std::map<std::string, CameraUri> cameras;
  for (const config::Camera& camera : config.camera()) {
    Result<CameraUri> uri = CameraUri::Parse(camera.uri());
    if (!uri) return uri.error().Annotated("camera " + camera.id());
    for (const config::Feature& feature : camera.feature()) {
      uri->options.emplace_back(feature.name(), feature.value());
    }
    cameras[camera.id()] = std::move(*uri);
  }
  return cameras;
}

HostFolders FoldersOf(const config::ServerConfig& config, const std::filesystem::path& data_dir) {
  return {.data_dir = data_dir,
          .picture_roots = {config.picture_root().begin(), config.picture_root().end()}};
}

int WorkersOf(const config::ServerConfig& config) {
  const int workers = config.processing().workers();
  return workers > 0 ? workers : static_cast<int>(std::thread::hardware_concurrency());
}

}  // namespace

Result<std::unique_ptr<Vision>> Vision::Open(const config::ServerConfig& config,
                                             const std::filesystem::path& data_dir,
                                             const Clock& clock) {
  std::unique_ptr<Vision> vision(new Vision(FoldersOf(config, data_dir)));
  VS_RETURN_IF_ERROR(vision->OpenStores(config, clock));
  VS_RETURN_IF_ERROR(vision->MakeServices(config, clock));
  return vision;
}

Vision::~Vision() = default;

void Vision::Close(const Deadline& end) {
  StopSequences();
  results_->Close(end.Left());
}

Status Vision::OpenStores(const config::ServerConfig& config, const Clock& clock) {
  const std::filesystem::path& data_dir = folders_.data_dir;
  const std::filesystem::path rigs =
      config.has_rigs_dir() ? std::filesystem::path(config.rigs_dir()) : data_dir / "rigs";
  const std::filesystem::path sequences = config.has_sequences_dir()
                                              ? std::filesystem::path(config.sequences_dir())
                                              : data_dir / "sequences";
  VS_ASSIGN_OR_RETURN(rigs_, RigFolder::Open(rigs));
  VS_ASSIGN_OR_RETURN(results_, ResultStore::Open(data_dir / "results.db", clock));
  VS_ASSIGN_OR_RETURN(sequences_, SequenceStore::Open(sequences, clock));
  scheduler_ = std::make_unique<Scheduler>(WorkersOf(config), clock);
  manager_ = std::make_unique<SequenceManager>(*sequences_, *scheduler_,
                                               Environment{.clock = &clock,
                                                           .cameras = &cameras_,
                                                           .rigs = rigs_.get(),
                                                           .topics = &topics_,
                                                           .results = results_.get(),
                                                           .folders = folders_});
  streams_ = std::make_unique<StreamHub>(topics_, clock);
  return Status();
}

Status Vision::MakeServices(const config::ServerConfig& config, const Clock& clock) {
  VS_ASSIGN_OR_RETURN(auto cameras, CamerasOf(config));
  for (const auto& [id, uri] : cameras) {
    if (Status status = cameras_.Name(id, uri); !status.ok()) {
      return status.Annotated("camera " + id);
    }
  }
  sequence_service_ = std::make_unique<SequenceService>(*sequences_, *manager_, clock);
  parameter_service_ = std::make_unique<ParameterService>(*manager_);
  stream_service_ = std::make_unique<StreamService>(*streams_, clock);
  camera_service_ = std::make_unique<CameraService>(cameras_, *manager_, std::move(cameras), clock);
  VS_ASSIGN_OR_RETURN(result_service_, ResultService::Make(*results_, folders_.data_dir, clock));
  return Status();
}

void Vision::Register(Router& router) {
  sequence_service_->Register(router);
  parameter_service_->Register(router);
  stream_service_->Register(router);
  camera_service_->Register(router);
  result_service_->Register(router);
}

}  // namespace vs
