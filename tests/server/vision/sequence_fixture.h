#pragma once

#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "server/convert/sequence.h"
#include "server/rpc/error_details.h"
#include "tests/engine/core/test_blocks.h"
#include "tests/server/vision/vision_fixture.h"

namespace vs::test {

namespace pb = visionserver::v1;

// Counts about 500 frames a second, adds an offset and publishes the sum.
inline SequenceSpec CountSpec() {
  SequenceSpec spec = ChainSpec("count", {"step"});
  spec.blocks.push_back({"publish", "Publish", {{"stream", std::string("sum")}}});
  spec.blocks.push_back({"check", "RangeCheck", {{"max", 1e9}}});
  spec.blocks.push_back({"log", "LogResult", {{"name_a", std::string("sum")}}});
  spec.connections.push_back(Wire("step.sum", "publish.value"));
  spec.connections.push_back(Wire("step.sum", "check.value"));
  spec.connections.push_back(Wire("step.sum", "log.a"));
  spec.connections.push_back(Wire("check.pass", "log.pass"));
  return spec;
}

inline pb::Value Integer(int64_t value) {
  pb::Value result;
  result.set_int_value(value);
  return result;
}

// The subjects of all faults that the error carries.
inline std::vector<std::string> SubjectsOf(const grpc::Status& status) {
  std::vector<std::string> subjects;
  pb::ErrorStatus whole;
  pb::ErrorDetail detail;
  if (whole.ParseFromString(status.error_details()) && whole.details_size() == 1 &&
      whole.details(0).UnpackTo(&detail)) {
    for (const pb::Fault& fault : detail.faults()) subjects.push_back(fault.subject());
  }
  return subjects;
}

// A server with the blocks of a test, and calls to its sequences.
class SequenceApi : public VisionTest {
 protected:
  SequenceApi() {
    ProbeOf("source").run = [](const StepRun&) {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));  // the pace of a camera
      return Status();
    };
  }
  ~SequenceApi() override {
    server_->vision().StopSequences();
    ClearProbes();
  }

  grpc::Status TryCreate(const SequenceSpec& spec) {
    pb::CreateSequenceRequest request;
    request.set_id(spec.id);
    *request.mutable_spec() = ToProto(spec);
    pb::Sequence created;
    return sequences_->CreateSequence(ClientCall(engineer_).context(), request, &created);
  }
  grpc::Status Update(const SequenceSpec& spec, const std::string& etag, pb::Sequence* updated) {
    pb::UpdateSequenceRequest request;
    request.set_id(spec.id);
    *request.mutable_spec() = ToProto(spec);
    request.set_etag(etag);
    return sequences_->UpdateSequence(ClientCall(engineer_).context(), request, updated);
  }
  int Stored() {
    pb::ListSequencesResponse list;
    EXPECT_TRUE(
        sequences_
            ->ListSequences(ClientCall(operator_).context(), pb::ListSequencesRequest(), &list)
            .ok());
    return list.sequences_size();
  }
};

}  // namespace vs::test
