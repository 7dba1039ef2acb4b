#pragma once

#include <memory>

#include "grpc/health/v1/health.pb.h"

#include "engine/base/status.h"
#include "server/rpc/router.h"
#include "server/services/health_board.h"

namespace vs {

// grpc.health.v1, over the health board.
class HealthService {
 public:
  explicit HealthService(HealthBoard& board) : board_(board) {}
  void Register(Router& router);

 private:
  using Request = grpc::health::v1::HealthCheckRequest;
  using Response = grpc::health::v1::HealthCheckResponse;

  Result<Response> Check(const Call& call, const Request& request);
  Result<std::unique_ptr<StreamSource>> Watch(const Call& call, const Request& request);

  HealthBoard& board_;
};

}  // namespace vs
