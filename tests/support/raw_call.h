#pragma once

#include <grpcpp/channel.h>
#include <grpcpp/support/status.h>

#include <memory>
#include <optional>
#include <string>

namespace vs::test {

// One call of any method, known by its name only, with bytes instead of messages: what a client
// sends that does not keep to the rules. The call is cancelled when the object goes.
class RawCall {
 public:
  RawCall(const std::shared_ptr<grpc::Channel>& channel, const std::string& method,
          const std::string& token, std::chrono::milliseconds timeout = std::chrono::minutes(1));
  ~RawCall();
  RawCall(const RawCall&) = delete;
  RawCall& operator=(const RawCall&) = delete;

  // False when the call has ended.
  bool Send(const std::string& bytes);
  void CloseRequests();
  // The next message; nothing when the call has ended.
  std::optional<std::string> Receive();
  // Waits for the end.
  grpc::Status Finish();
  void Cancel();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

struct RawAnswer {
  grpc::Status status;
  std::string message;  // the first one
};

// A unary call, or a stream of which only the first message counts.
RawAnswer CallRaw(const std::shared_ptr<grpc::Channel>& channel, const std::string& method,
                  const std::string& token, const std::string& request = "");

}  // namespace vs::test
