#pragma once

#include "client/call.h"
#include "client/cli/command_line.h"
#include "client/cli/output.h"
#include "client/cli/session.h"

// What the files of commands are written with.

namespace vs::cli {

namespace v1 = ::visionserver::v1;

using client::Result;

// NOLINTBEGIN(bugprone-macro-parentheses): a declaration cannot stand in parentheses.
// Leaves a command with the error of `expression` (a Result), if it has one.
#define VS_CLI_TRY(target, expression) VS_CLI_TRY_NAMED_(VS_CLI_NAME_(__LINE__), target, expression)
#define VS_CLI_NAME_(line) VS_CLI_JOIN_(vs_result_, line)
#define VS_CLI_JOIN_(a, b) a##b
#define VS_CLI_TRY_NAMED_(result, target, expression)       \
  auto result = (expression);                               \
  if (!(result)) return ::tl::unexpected((result).error()); \
  target = std::move(*result)
// NOLINTEND(bugprone-macro-parentheses)

// The answer of a method that no member of Client stands for.
template <class Stub, class Request, class Response>
Result<Response> Ask(Session& session,
                     grpc::Status (Stub::*method)(grpc::ClientContext*, const Request&, Response*),
                     const std::type_identity_t<Request>& request) {
  VS_CLI_TRY(client::Client * client, session.Connect());
  return client::Call(*client->connection(), method, request);
}

// The answer as JSON if that was asked for, otherwise as `print` shows it to people.
template <class Response, class Print>
Result<void> Show(const Session& session, const Result<Response>& response, Print print) {
  if (!response) return tl::unexpected(response.error());
  if (session.options().json) {
    PrintJson(*response);
  } else {
    print(*response);
  }
  return {};
}

}  // namespace vs::cli
