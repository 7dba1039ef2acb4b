#pragma once

#include <grpcpp/grpcpp.h>

#include <memory>
#include <string>

#include "visionserver/v1/error.pb.h"

namespace vs::test {

// Metadata and a generous deadline for one call of a generated stub:
//   stub->WhoAmI(ClientCall(token).context(), request, &response)
class ClientCall {
 public:
  explicit ClientCall(const std::string& token) {
    if (!token.empty()) context_.AddMetadata("authorization", "Bearer " + token);
    context_.set_deadline(std::chrono::system_clock::now() + std::chrono::minutes(1));
  }
  grpc::ClientContext* context() { return &context_; }

 private:
  grpc::ClientContext context_;
};

// The machine-readable reason of an error, empty when it carries none.
inline std::string ReasonOf(const grpc::Status& status) {
  visionserver::v1::ErrorStatus whole;
  visionserver::v1::ErrorDetail detail;
  if (!whole.ParseFromString(status.error_details()) || whole.details_size() != 1 ||
      !whole.details(0).UnpackTo(&detail)) {
    return "";
  }
  return detail.reason();
}

}  // namespace vs::test
