#pragma once

#include <string>
#include <vector>

#include "visionserver/v1/parameter.pb.h"

#include "engine/base/status.h"
#include "server/rpc/router.h"
#include "server/sequences/sequence_manager.h"

namespace vs {

// Reading and changing the parameters of sequences: see parameter.proto.
class ParameterService {
 public:
  // Must outlive it.
  explicit ParameterService(SequenceManager& manager) : manager_(manager) {}
  void Register(Router& router);

 private:
  Result<visionserver::v1::ListParametersResponse> ListParameters(
      const Call& call, const visionserver::v1::ListParametersRequest& request);
  Result<visionserver::v1::GetParametersResponse> GetParameters(
      const Call& call, const visionserver::v1::GetParametersRequest& request);
  Result<visionserver::v1::SetParametersResponse> SetParameters(
      const Call& call, const visionserver::v1::SetParametersRequest& request);
  Result<visionserver::v1::SetParametersResponse> ResetParameters(
      const Call& call, const visionserver::v1::ResetParametersRequest& request);
  Result<std::unique_ptr<StreamSource>> WatchParameters(
      const Call& call, const visionserver::v1::WatchParametersRequest& request);

  SequenceManager& manager_;
};

}  // namespace vs
