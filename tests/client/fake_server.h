#pragma once

#include <grpcpp/server.h>

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "visionserver/v1/result.grpc.pb.h"
#include "visionserver/v1/stream.grpc.pb.h"
#include "visionserver/v1/system.grpc.pb.h"

#include "tests/client/certificates.h"

namespace vs::test {

namespace v1 = ::visionserver::v1;

// One stream that follows the rules of stream.proto: newest item only, at most `window` of them
// without acknowledgement.
class FakeStreams final : public v1::StreamService::Service {
 public:
  // The newest item from now on; its seq counts from 1.
  void Publish(v1::StreamItem item = {});
  // Ends open streams with this status, and later ones at once if `stay`.
  void Cut(const grpc::Status& status, bool stay = false);
  // Sent as a notice to whoever subscribes.
  void SetNotice(std::string notice);

  // Wait for something that must happen; false when it does not.
  bool WaitForAcknowledged(uint64_t seq);
  bool WaitForStreams(int opened);
  uint64_t sent() const;
  std::string last_credential() const;

 private:
  grpc::Status Subscribe(grpc::ServerContext* context, const v1::SubscribeRequest* request,
                         grpc::ServerWriter<v1::StreamItem>* writer) override;
  grpc::Status Ack(grpc::ServerContext* context, const v1::AckRequest* request,
                   v1::AckResponse* response) override;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  v1::StreamItem newest_;
  std::string notice_;
  std::optional<grpc::Status> refusal_;
  grpc::Status cut_status_;
  int cuts_ = 0;
  int opened_ = 0;
  std::string open_stream_;    // id; empty when there is none
  uint64_t sent_ = 0;          // items, of all streams
  uint64_t acknowledged_ = 0;  // newest of the stream that is open
  std::string last_credential_;
};

// Results 1..n, which may be watched from any of them on.
class FakeResults final : public v1::ResultService::Service {
 public:
  void Store(int count);
  // Ends open streams.
  void Cut();
  // Ends open streams and forgets all results: the next one has the number 1.
  void BeginAnew();
  // From now on ListResults answers only those who go.
  void StopListing();
  bool WaitForStreams(int opened);
  bool WaitForLists(int asked);

 private:
  grpc::Status WatchResults(grpc::ServerContext* context, const v1::WatchResultsRequest* request,
                            grpc::ServerWriter<v1::Result>* writer) override;
  grpc::Status ListResults(grpc::ServerContext* context, const v1::ListResultsRequest* request,
                           v1::ListResultsResponse* response) override;

  std::mutex mutex_;
  std::condition_variable changed_;
  uint64_t stored_ = 0;
  int cuts_ = 0;
  int opened_ = 0;
  int lists_ = 0;
  bool listing_ = true;
};

class FakeSystem final : public v1::SystemService::Service {
  grpc::Status GetServerInfo(grpc::ServerContext* context, const v1::GetServerInfoRequest* request,
                             v1::GetServerInfoResponse* response) override;
};

// Serves the three on 127.0.0.1, as plain text or with a certificate.
class FakeServer {
 public:
  explicit FakeServer(const CertificatePair* certificate = nullptr, int port = 0);
  ~FakeServer();
  FakeServer(const FakeServer&) = delete;
  FakeServer& operator=(const FakeServer&) = delete;

  int port() const { return port_; }
  std::string Address() const { return "127.0.0.1:" + std::to_string(port_); }
  FakeStreams& streams() { return streams_; }
  FakeResults& results() { return results_; }

 private:
  FakeStreams streams_;
  FakeResults results_;
  FakeSystem system_;
  int port_ = 0;
  std::unique_ptr<grpc::Server> server_;
};

}  // namespace vs::test
