#include "client/acknowledger.h"

#include <utility>

#include "visionserver/v1/stream.grpc.pb.h"

namespace vs::client {

namespace v1 = ::visionserver::v1;

struct Acknowledger::Call {
  explicit Call(const std::shared_ptr<grpc::Channel>& channel) : stub(channel) {}

  grpc::ClientContext context;
  v1::StreamService::Stub stub;
  v1::AckRequest request;
  v1::AckResponse response;
};

Acknowledger::Acknowledger(std::shared_ptr<Connection> connection)
    : connection_(std::move(connection)) {}

Acknowledger::~Acknowledger() {
  std::unique_lock lock(mutex_);
  waiting_.reset();
  if (call_) call_->context.TryCancel();
  idle_.wait(lock, [this] { return call_ == nullptr; });
}

void Acknowledger::Begin(std::string stream_id) {
  const std::lock_guard lock(mutex_);
  stream_id_ = std::move(stream_id);
  waiting_.reset();
}

void Acknowledger::Acknowledge(uint32_t subscription_id, uint64_t seq) {
  const std::lock_guard lock(mutex_);
  subscription_id_ = subscription_id;
  if (call_) {
    waiting_ = seq;
  } else {
    Send(subscription_id, seq);
  }
}

void Acknowledger::Send(uint32_t subscription_id, uint64_t seq) {
  call_ = std::make_unique<Call>(connection_->channel());
  connection_->Prepare(call_->context, connection_->options().call_timeout);
  call_->request.set_stream_id(stream_id_);
  v1::Acknowledgement* item = call_->request.add_items();
  item->set_subscription_id(subscription_id);
  item->set_seq(seq);
  // A failed call needs no care: the stream that it belongs to ends, too, and is opened again.
  call_->stub.async()->Ack(&call_->context, &call_->request, &call_->response,
                           [this](const grpc::Status&) { Answered(); });
}

void Acknowledger::Answered() {
  const std::lock_guard lock(mutex_);
  call_.reset();
  if (waiting_) Send(subscription_id_, *std::exchange(waiting_, std::nullopt));
  if (!call_) idle_.notify_all();
}

}  // namespace vs::client
