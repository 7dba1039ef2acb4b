#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "engine/base/clock.h"
#include "engine/base/deadline.h"
#include "engine/base/host_folders.h"
#include "engine/base/status.h"
#include "engine/camera/camera_hub.h"
#include "engine/core/scheduler.h"
#include "engine/core/topic.h"
#include "server/config/config.h"
#include "server/results/result_store.h"
#include "server/rigs/rig_folder.h"
#include "server/rpc/router.h"
#include "server/sequences/sequence_manager.h"
#include "server/sequences/sequence_store.h"
#include "server/services/camera_service.h"
#include "server/services/parameter_service.h"
#include "server/services/result_service.h"
#include "server/services/sequence_service.h"
#include "server/services/stream_service.h"
#include "server/streams/stream_hub.h"

namespace vs {

// The half of a server that sees: cameras, rigs, sequences, results and streams, with the services
// over them.
class Vision {
 public:
  // Opens everything under `data_dir`; runs nothing yet. `clock` must outlive it.
  static Result<std::unique_ptr<Vision>> Open(const config::ServerConfig& config,
                                              const std::filesystem::path& data_dir,
                                              const Clock& clock);
  // Stops what runs and writes what is queued.
  ~Vision();
  Vision(const Vision&) = delete;
  Vision& operator=(const Vision&) = delete;

  void Register(Router& router);
  // Starts the sequences that are marked for it.
  void StartSequences() { manager_->StartMarked(); }
  // After this nothing starts any more.
  void StopSequences() { manager_->StopAll(); }
  // Stops what runs and writes what it logged, as ResultStore::Close.
  void Close(const Deadline& end);

  SequenceManager& sequences() { return *manager_; }
  ResultStore& results() { return *results_; }
  CameraService& cameras() { return *camera_service_; }

 private:
  explicit Vision(const HostFolders& folders) : folders_(folders), cameras_(folders) {}
  Status OpenStores(const config::ServerConfig& config, const Clock& clock);
  Status MakeServices(const config::ServerConfig& config, const Clock& clock);

  // In the order in which they need each other; they go in the opposite one.
  const HostFolders folders_;
  CameraHub cameras_;
  TopicHub topics_;
  std::unique_ptr<RigFolder> rigs_;
  std::unique_ptr<ResultStore> results_;
  std::unique_ptr<SequenceStore> sequences_;
  std::unique_ptr<Scheduler> scheduler_;
  std::unique_ptr<SequenceManager> manager_;
  std::unique_ptr<StreamHub> streams_;
  std::unique_ptr<SequenceService> sequence_service_;
  std::unique_ptr<ParameterService> parameter_service_;
  std::unique_ptr<StreamService> stream_service_;
  std::unique_ptr<CameraService> camera_service_;
  std::unique_ptr<ResultService> result_service_;
};

}  // namespace vs
