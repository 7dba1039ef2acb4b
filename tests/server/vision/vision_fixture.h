#pragma once

#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "visionserver/v1/parameter.grpc.pb.h"
#include "visionserver/v1/result.grpc.pb.h"
#include "visionserver/v1/sequence.grpc.pb.h"
#include "visionserver/v1/stream.grpc.pb.h"

#include "engine/core/sequence_spec.h"
#include "server/access/caller.h"
#include "tests/support/client_call.h"
#include "tests/support/test_server.h"

namespace vs::test {

class SteadyClient;

// A whole server with a real client's stubs: everything goes over the network interface.
class VisionTest : public ::testing::Test {
 protected:
  explicit VisionTest(TestServerOptions options = {}) : server_(std::move(options)) {}

  // Stores a sequence as an engineer; fails the test when it is refused.
  visionserver::v1::Sequence Create(const SequenceSpec& spec, bool allow_faults = false);
  grpc::Status Start(const std::string& id);
  grpc::Status Stop(const std::string& id);
  visionserver::v1::SequenceState State(const std::string& id);
  // Sets one parameter with the token's rights.
  grpc::Status Set(const std::string& token, const std::string& sequence, const std::string& path,
                   const visionserver::v1::Value& value,
                   visionserver::v1::SetParametersResponse* response);
  // Stores and starts the sequence "bystander", which nobody disturbs, and reads its pictures.
  std::unique_ptr<SteadyClient> StartBystander();

  TestServer server_;
  const std::shared_ptr<grpc::Channel> channel_ = server_.Connect();
  const std::string engineer_ = server_.Token(Role::kEngineer);
  const std::string operator_ = server_.Token(Role::kOperator);
  const std::unique_ptr<visionserver::v1::SequenceService::Stub> sequences_ =
      visionserver::v1::SequenceService::NewStub(channel_);
  const std::unique_ptr<visionserver::v1::ParameterService::Stub> parameters_ =
      visionserver::v1::ParameterService::NewStub(channel_);
  const std::unique_ptr<visionserver::v1::StreamService::Stub> streams_ =
      visionserver::v1::StreamService::NewStub(channel_);
  const std::unique_ptr<visionserver::v1::ResultService::Stub> results_ =
      visionserver::v1::ResultService::NewStub(channel_);
};

// A client of Subscribe that reads when told to, on a connection of its own.
class StreamClient {
 public:
  StreamClient(std::shared_ptr<grpc::Channel> channel, std::string token,
               const std::vector<visionserver::v1::Subscription>& subscriptions);
  ~StreamClient();

  // The next item with a picture or value; false at the end of the stream. Notices are kept.
  bool Read(visionserver::v1::StreamItem* item);
  void Ack(const visionserver::v1::StreamItem& item);
  // Reads and acknowledges.
  bool Take(visionserver::v1::StreamItem* item);
  // Ends the stream, also while another thread reads and acknowledges.
  void Cancel();
  grpc::Status Finish();
  const std::vector<std::string>& notices() const { return notices_; }
  const std::string& stream_id() const { return stream_id_; }

 private:
  const std::string token_;
  const std::unique_ptr<visionserver::v1::StreamService::Stub> stub_;
  const std::unique_ptr<ClientCall> call_;
  std::unique_ptr<grpc::ClientReader<visionserver::v1::StreamItem>> reader_;
  std::string stream_id_;
  std::vector<std::string> notices_;
  std::atomic<bool> cancelled_ = false;
};

visionserver::v1::Subscription Wish(uint32_t id, const std::string& stream, uint32_t window = 2);

// A client that reads all the while, to show that what goes wrong elsewhere costs it nothing.
class SteadyClient {
 public:
  // Waits for the first picture of `stream`.
  SteadyClient(std::shared_ptr<grpc::Channel> channel, const std::string& token,
               const std::string& stream);
  ~SteadyClient();
  SteadyClient(const SteadyClient&) = delete;
  SteadyClient& operator=(const SteadyClient&) = delete;

  // Waits for a picture that is taken after this call. False when none comes, or when the stream
  // or its sequence was ever interrupted.
  bool GoesOn();

 private:
  void Read();

  StreamClient client_;
  std::atomic<int64_t> newest_capture_ns_ = 0;
  std::atomic<bool> interrupted_ = false;
  std::jthread reader_;  // last: everything it uses exists before it starts
};

}  // namespace vs::test
