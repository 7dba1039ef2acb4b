#pragma once

#include <memory>

#include "visionserver/v1/sequence.pb.h"

#include "engine/base/clock.h"
#include "engine/base/status.h"
#include "server/rpc/router.h"
#include "server/sequences/sequence_manager.h"
#include "server/sequences/sequence_store.h"
#include "server/services/shared_observations.h"

namespace vs {

// Storing, checking, starting and watching sequences: see sequence.proto.
class SequenceService {
 public:
  // All must outlive it, and it its open streams.
  SequenceService(SequenceStore& store, SequenceManager& manager, const Clock& clock);
  void Register(Router& router);

 private:
  Result<visionserver::v1::ListSequencesResponse> ListSequences(
      const Call& call, const visionserver::v1::ListSequencesRequest& request);
  Result<visionserver::v1::Sequence> GetSequence(
      const Call& call, const visionserver::v1::GetSequenceRequest& request);
  Result<visionserver::v1::Sequence> CreateSequence(
      const Call& call, const visionserver::v1::CreateSequenceRequest& request);
  Result<visionserver::v1::Sequence> UpdateSequence(
      const Call& call, const visionserver::v1::UpdateSequenceRequest& request);
  Result<visionserver::v1::DeleteSequenceResponse> DeleteSequence(
      const Call& call, const visionserver::v1::DeleteSequenceRequest& request);
  Result<visionserver::v1::ValidateSequenceResponse> ValidateSequence(
      const Call& call, const visionserver::v1::ValidateSequenceRequest& request);
  Result<visionserver::v1::ListBlockTypesResponse> ListBlockTypes(
      const Call& call, const visionserver::v1::ListBlockTypesRequest& request);
  Result<visionserver::v1::SequenceState> StartSequence(
      const Call& call, const visionserver::v1::StartSequenceRequest& request);
  Result<visionserver::v1::SequenceState> StopSequence(
      const Call& call, const visionserver::v1::StopSequenceRequest& request);
  Result<visionserver::v1::SequenceState> GetSequenceState(
      const Call& call, const visionserver::v1::GetSequenceStateRequest& request);
  Result<std::unique_ptr<StreamSource>> WatchSequence(
      const Call& call, const visionserver::v1::WatchSequenceRequest& request);

  // The stored sequence with its run state.
  visionserver::v1::Sequence Described(const StoredSequence& stored, bool with_spec);
  Result<visionserver::v1::SequenceState> StateOf(const std::string& id);

  SequenceStore& store_;
  SequenceManager& manager_;
  SharedObservations states_;
  const std::shared_ptr<void> listening_;  // the first to hear of a change: it renews states_
};

}  // namespace vs
