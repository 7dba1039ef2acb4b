#pragma once

#include <memory>

#include "client/connection.h"

namespace vs::client {

// Any method of any service that answers once:
//   auto types = Call(*client->connection(), &v1::SequenceService::Stub::ListBlockTypes, {});
// The everyday ones are members of Client. Ends after ConnectOptions::call_timeout, or `timeout`.
template <class Stub, class Request, class Response>
Result<Response> Call(const Connection& connection,
                      grpc::Status (Stub::*method)(grpc::ClientContext*, const Request&, Response*),
                      const std::type_identity_t<Request>& request,
                      std::optional<std::chrono::milliseconds> timeout = std::nullopt) {
  grpc::ClientContext context;
  connection.Prepare(context, timeout.value_or(connection.options().call_timeout));
  Stub stub(connection.channel());
  Response response;
  const grpc::Status status = (stub.*method)(&context, request, &response);
  if (!status.ok()) return tl::unexpected(ToError(status));
  return response;
}

}  // namespace vs::client
