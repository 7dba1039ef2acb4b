#pragma once

#include <string>
#include <vector>

#include "visionserver/v1/camera.pb.h"

#include "engine/base/status.h"
#include "engine/camera/camera_source.h"
#include "engine/camera/gvcp.h"

namespace vs {

// What the server knows of one camera.
struct CameraEntry {
  std::string id;
  std::string uri;
  CameraStats stats;
  std::vector<std::string> used_by;  // sequences
};

visionserver::v1::Camera ToProto(const CameraEntry& entry);
visionserver::v1::FeatureInfo ToProto(const FeatureInfo& info);
visionserver::v1::FeatureValue ToProto(const std::string& name, const FeatureValue& value);
// INVALID_ARGUMENT for what no feature can hold.
Result<FeatureValue> FromProto(const visionserver::v1::FeatureValue& value);

}  // namespace vs
