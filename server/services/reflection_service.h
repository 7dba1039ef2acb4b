#pragma once

#include "grpc/reflection/v1alpha/reflection.pb.h"

#include "engine/base/status.h"
#include "server/rpc/router.h"

namespace vs {

// grpc.reflection.v1alpha: tells tools the interface of the methods in the router.
class ReflectionService {
 public:
  // Registers itself as well. `router` must outlive it.
  void Register(Router& router);

 private:
  using Request = grpc::reflection::v1alpha::ServerReflectionRequest;
  using Response = grpc::reflection::v1alpha::ServerReflectionResponse;

  Result<Response> Info(const Call& call, const Request& request);

  const Router* router_ = nullptr;
};

}  // namespace vs
