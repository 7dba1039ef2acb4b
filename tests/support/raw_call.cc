#include "tests/support/raw_call.h"

#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/grpcpp.h>

#include <chrono>

namespace vs::test {

struct RawCall::State {
  explicit State(const std::shared_ptr<grpc::Channel>& channel) : stub(channel) {}

  // Waits for the operation that was just begun; there is never more than one.
  bool Wait() {
    void* tag = nullptr;
    bool ok = false;
    return queue.Next(&tag, &ok) && ok;
  }

  grpc::GenericStub stub;
  grpc::ClientContext context;
  grpc::CompletionQueue queue;
  std::unique_ptr<grpc::GenericClientAsyncReaderWriter> call;
};

RawCall::RawCall(const std::shared_ptr<grpc::Channel>& channel, const std::string& method,
                 const std::string& token, std::chrono::milliseconds timeout)
    : state_(std::make_unique<State>(channel)) {
  if (!token.empty()) state_->context.AddMetadata("authorization", "Bearer " + token);
  state_->context.set_deadline(std::chrono::system_clock::now() + timeout);
  state_->call = state_->stub.PrepareCall(&state_->context, method, &state_->queue);
  state_->call->StartCall(nullptr);
  state_->Wait();
}

RawCall::~RawCall() {
  state_->context.TryCancel();
  state_->queue.Shutdown();
  void* tag = nullptr;
  bool ok = false;
  while (state_->queue.Next(&tag, &ok)) {
  }
}

bool RawCall::Send(const std::string& bytes) {
  const grpc::Slice slice(bytes);
  state_->call->Write(grpc::ByteBuffer(&slice, 1), nullptr);
  return state_->Wait();
}

void RawCall::CloseRequests() {
  state_->call->WritesDone(nullptr);
  state_->Wait();
}

std::optional<std::string> RawCall::Receive() {
  grpc::ByteBuffer buffer;
  state_->call->Read(&buffer, nullptr);
  if (!state_->Wait()) return std::nullopt;
  grpc::Slice slice;
  if (!buffer.DumpToSingleSlice(&slice).ok()) return std::nullopt;
  return std::string(reinterpret_cast<const char*>(slice.begin()), slice.size());
}

grpc::Status RawCall::Finish() {
  grpc::Status status;
  state_->call->Finish(&status, nullptr);
  state_->Wait();
  return status;
}

void RawCall::Cancel() { state_->context.TryCancel(); }

RawAnswer CallRaw(const std::shared_ptr<grpc::Channel>& channel, const std::string& method,
                  const std::string& token, const std::string& request) {
  RawCall call(channel, method, token);
  if (call.Send(request)) call.CloseRequests();
  const std::optional<std::string> first = call.Receive();
  // A stream would go on.
  if (first && call.Receive()) call.Cancel();
  return {.status = call.Finish(), .message = first.value_or("")};
}

}  // namespace vs::test
