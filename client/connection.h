#pragma once

#include <grpcpp/channel.h>
#include <grpcpp/client_context.h>
#include <grpcpp/support/status.h>

#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "client/error.h"
#include "client/options.h"

namespace vs::client {

// The gRPC channel to a server and the credential that calls carry. Thread-safe. The channel comes
// back by itself after the connection is lost, with pauses that grow to 5 s.
class Connection {
 public:
  // Returns once connected. Errors: INVALID_ARGUMENT for options that make no sense; UNAVAILABLE
  // with the reason of FetchCertificate, CERTIFICATE_MISMATCH, CERTIFICATE_UNTRUSTED or
  // CONNECTION_FAILED, and what to do about it.
  static Result<std::shared_ptr<Connection>> Open(const ConnectOptions& options);

  const ConnectOptions& options() const { return options_; }
  const std::shared_ptr<grpc::Channel>& channel() const { return channel_; }

  void SetCredential(std::string credential);

  // Gives the call its credential, and its deadline if `timeout` is set.
  void Prepare(grpc::ClientContext& context,
               std::optional<std::chrono::milliseconds> timeout) const;

 private:
  Connection(ConnectOptions options, std::shared_ptr<grpc::Channel> channel);

  const ConnectOptions options_;
  const std::shared_ptr<grpc::Channel> channel_;
  mutable std::mutex mutex_;
  std::string credential_;
};

// What a failed call says, with the details that the server sent along.
Error ToError(const grpc::Status& status);

}  // namespace vs::client
