#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "visionserver/v1/camera.pb.h"

#include "engine/base/clock.h"
#include "engine/base/status.h"
#include "engine/camera/camera_hub.h"
#include "server/convert/camera.h"
#include "server/rpc/router.h"
#include "server/sequences/sequence_manager.h"
#include "server/services/shared_observations.h"

namespace vs {

// Cameras and their features: see camera.proto.
class CameraService {
 public:
  // `cameras`: those of the configuration, by id. The references must outlive it, and it its open
  // streams.
  CameraService(CameraHub& hub, SequenceManager& manager, std::map<std::string, CameraUri> cameras,
                const Clock& clock);
  void Register(Router& router);

  // All cameras that somebody knows.
  std::vector<CameraEntry> Cameras();

 private:
  Result<visionserver::v1::ListCamerasResponse> ListCameras(
      const Call& call, const visionserver::v1::ListCamerasRequest& request);
  Result<visionserver::v1::DiscoverCamerasResponse> DiscoverCameras(
      const Call& call, const visionserver::v1::DiscoverCamerasRequest& request);
  Result<visionserver::v1::Camera> GetCamera(const Call& call,
                                             const visionserver::v1::GetCameraRequest& request);
  Result<visionserver::v1::ListFeaturesResponse> ListFeatures(
      const Call& call, const visionserver::v1::ListFeaturesRequest& request);
  Result<visionserver::v1::GetFeaturesResponse> GetFeatures(
      const Call& call, const visionserver::v1::GetFeaturesRequest& request);
  Result<visionserver::v1::SetFeaturesResponse> SetFeatures(
      const Call& call, const visionserver::v1::SetFeaturesRequest& request);
  Result<visionserver::v1::TriggerCameraResponse> TriggerCamera(
      const Call& call, const visionserver::v1::TriggerCameraRequest& request);
  Result<std::unique_ptr<StreamSource>> WatchCameras(
      const Call& call, const visionserver::v1::WatchCamerasRequest& request);

  SharedObservations::List Observe();
  // Where the camera of this id (a name, or the URI of a camera that is open) is.
  Result<CameraUri> Find(const std::string& id);
  // The camera as it is open, or opened just to look at it.
  Result<std::shared_ptr<CameraSource>> Borrow(const std::string& id);

  CameraHub& hub_;
  SequenceManager& manager_;
  const std::map<std::string, CameraUri> cameras_;
  SharedObservations observed_;
};

}  // namespace vs
