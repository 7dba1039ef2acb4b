#include "tests/server/vision/vision_fixture.h"

#include <utility>

#include "engine/base/clock.h"
#include "server/convert/sequence.h"
#include "tests/support/wait_until.h"

namespace vs::test {

namespace pb = visionserver::v1;

pb::Sequence VisionTest::Create(const SequenceSpec& spec, bool allow_faults) {
  pb::CreateSequenceRequest request;
  request.set_id(spec.id);
  *request.mutable_spec() = ToProto(spec);
  request.set_allow_faults(allow_faults);
  pb::Sequence created;
  const grpc::Status status =
      sequences_->CreateSequence(ClientCall(engineer_).context(), request, &created);
  EXPECT_TRUE(status.ok()) << status.error_message();
  return created;
}

grpc::Status VisionTest::Start(const std::string& id) {
  pb::StartSequenceRequest request;
  request.set_id(id);
  pb::SequenceState state;
  return sequences_->StartSequence(ClientCall(operator_).context(), request, &state);
}

grpc::Status VisionTest::Stop(const std::string& id) {
  pb::StopSequenceRequest request;
  request.set_id(id);
  pb::SequenceState state;
  return sequences_->StopSequence(ClientCall(operator_).context(), request, &state);
}

pb::SequenceState VisionTest::State(const std::string& id) {
  pb::GetSequenceStateRequest request;
  request.set_id(id);
  pb::SequenceState state;
  const grpc::Status status =
      sequences_->GetSequenceState(ClientCall(operator_).context(), request, &state);
  EXPECT_TRUE(status.ok()) << status.error_message();
  return state;
}

grpc::Status VisionTest::Set(const std::string& token, const std::string& sequence,
                             const std::string& path, const pb::Value& value,
                             pb::SetParametersResponse* response) {
  pb::SetParametersRequest request;
  request.set_sequence(sequence);
  pb::ParameterValue* one = request.add_values();
  one->set_path(path);
  *one->mutable_value() = value;
  return parameters_->SetParameters(ClientCall(token).context(), request, response);
}

std::unique_ptr<SteadyClient> VisionTest::StartBystander() {
  SequenceSpec spec;
  spec.id = "bystander";
  spec.blocks = {{"source", "SimulatedStereo", {{"rate_hz", 10.0}}},
                 {"small", "Resize", {{"scale", 0.2}}},
                 {"publish", "Publish", {{"stream", std::string("pair")}}}};
  spec.connections = {{"source", "pair", "small", "pair"},
                      {"small", "resized", "publish", "value"}};
  Create(spec);
  const grpc::Status started = Start(spec.id);
  EXPECT_TRUE(started.ok()) << started.error_message();
  return std::make_unique<SteadyClient>(server_.Connect(), operator_, "bystander/pair");
}

StreamClient::StreamClient(std::shared_ptr<grpc::Channel> channel, std::string token,
                           const std::vector<pb::Subscription>& subscriptions)
    : token_(std::move(token)),
      stub_(pb::StreamService::NewStub(std::move(channel))),
      call_(std::make_unique<ClientCall>(token_)) {
  pb::SubscribeRequest request;
  for (const pb::Subscription& one : subscriptions) *request.add_subscriptions() = one;
  // Longer than a test lasts.
  call_->context()->set_deadline(std::chrono::system_clock::now() + std::chrono::minutes(10));
  reader_ = stub_->Subscribe(call_->context(), request);
  pb::StreamItem greeting;
  if (reader_->Read(&greeting)) stream_id_ = greeting.stream_id();
}

StreamClient::~StreamClient() {
  if (reader_ == nullptr) return;
  Cancel();
  (void)reader_->Finish();
}

bool StreamClient::Read(pb::StreamItem* item) {
  while (reader_->Read(item)) {
    if (item->notice().empty()) return true;
    notices_.push_back(item->notice());
  }
  return false;
}

void StreamClient::Ack(const pb::StreamItem& item) {
  pb::AckRequest request;
  request.set_stream_id(stream_id_);
  pb::Acknowledgement* one = request.add_items();
  one->set_subscription_id(item.subscription_id());
  one->set_seq(item.seq());
  pb::AckResponse response;
  const grpc::Status status = stub_->Ack(ClientCall(token_).context(), request, &response);
  EXPECT_TRUE(status.ok() || cancelled_) << status.error_message();
}

bool StreamClient::Take(pb::StreamItem* item) {
  if (!Read(item)) return false;
  Ack(*item);
  return true;
}

void StreamClient::Cancel() {
  cancelled_ = true;
  call_->context()->TryCancel();
}

grpc::Status StreamClient::Finish() { return std::exchange(reader_, nullptr)->Finish(); }

pb::Subscription Wish(uint32_t id, const std::string& stream, uint32_t window) {
  pb::Subscription wanted;
  wanted.set_id(id);
  wanted.set_stream(stream);
  wanted.set_window(window);
  return wanted;
}

SteadyClient::SteadyClient(std::shared_ptr<grpc::Channel> channel, const std::string& token,
                           const std::string& stream)
    : client_(std::move(channel), token, {Wish(1, stream)}), reader_([this] { Read(); }) {
  EXPECT_TRUE(GoesOn());
}

SteadyClient::~SteadyClient() { client_.Cancel(); }

bool SteadyClient::GoesOn() {
  const int64_t now_ns = SystemClock().MonotonicNs();
  return WaitUntil([&] { return interrupted_ || newest_capture_ns_ > now_ns; }) && !interrupted_;
}

void SteadyClient::Read() {
  uint64_t frame = 0;
  pb::StreamItem item;
  while (client_.Take(&item)) {
    // The numbers of a new run begin anew.
    if (item.header().frame_number() <= frame) interrupted_ = true;
    frame = item.header().frame_number();
    newest_capture_ns_ = item.header().capture_ns();
  }
  interrupted_ = true;
}

}  // namespace vs::test
