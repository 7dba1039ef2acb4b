#include "tests/client/fake_server.h"

#include <grpcpp/server_builder.h>
#include <gtest/gtest.h>

#include <utility>

#include "tests/support/child_process.h"

namespace vs::test {
namespace {

// A stream looks so often whether its client is still there.
constexpr std::chrono::milliseconds kGlance{20};

std::string Credential(const grpc::ServerContext& context) {
  const auto found = context.client_metadata().find("authorization");
  return found == context.client_metadata().end()
             ? ""
             : std::string(found->second.data(), found->second.size());
}

}  // namespace

void FakeStreams::Publish(v1::StreamItem item) {
  const std::lock_guard lock(mutex_);
  item.set_seq(newest_.seq() + 1);
  newest_ = std::move(item);
  changed_.notify_all();
}

void FakeStreams::Cut(const grpc::Status& status, bool stay) {
  const std::lock_guard lock(mutex_);
  ++cuts_;
  cut_status_ = status;
  open_stream_.clear();
  if (stay) refusal_ = status;
  changed_.notify_all();
}

void FakeStreams::SetNotice(std::string notice) {
  const std::lock_guard lock(mutex_);
  notice_ = std::move(notice);
}

bool FakeStreams::WaitForAcknowledged(uint64_t seq) {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, kPatience, [&] { return acknowledged_ >= seq; });
}

bool FakeStreams::WaitForStreams(int opened) {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, kPatience, [&] { return opened_ >= opened; });
}

uint64_t FakeStreams::sent() const {
  const std::lock_guard lock(mutex_);
  return sent_;
}

std::string FakeStreams::last_credential() const {
  const std::lock_guard lock(mutex_);
  return last_credential_;
}

grpc::Status FakeStreams::Subscribe(grpc::ServerContext* context,
                                    const v1::SubscribeRequest* request,
                                    grpc::ServerWriter<v1::StreamItem>* writer) {
  std::unique_lock lock(mutex_);
  last_credential_ = Credential(*context);
  if (refusal_) return *refusal_;
  const v1::Subscription& subscription = request->subscriptions(0);
  const int cuts = cuts_;
  ++opened_;
  acknowledged_ = 0;
  uint64_t newest_sent = 0;
  std::vector<uint64_t> under_way;
  v1::StreamItem first;
  open_stream_ = "stream-" + std::to_string(opened_);
  first.set_stream_id(open_stream_);
  writer->Write(first);
  if (!notice_.empty()) {
    v1::StreamItem notice;
    notice.set_subscription_id(subscription.id());
    notice.set_notice(notice_);
    writer->Write(notice);
  }
  changed_.notify_all();
  while (!context->IsCancelled() && cuts_ == cuts) {
    std::erase_if(under_way, [this](uint64_t seq) { return seq <= acknowledged_; });
    if (newest_.seq() == newest_sent || under_way.size() >= subscription.window()) {
      changed_.wait_for(lock, kGlance);
      continue;
    }
    v1::StreamItem item = newest_;
    item.set_subscription_id(subscription.id());
    item.set_dropped(newest_sent == 0 ? 0 : item.seq() - newest_sent - 1);
    newest_sent = item.seq();
    under_way.push_back(newest_sent);
    ++sent_;
    changed_.notify_all();
    lock.unlock();
    writer->Write(item);
    lock.lock();
  }
  return cut_status_;
}

grpc::Status FakeStreams::Ack(grpc::ServerContext* /*context*/, const v1::AckRequest* request,
                              v1::AckResponse* /*response*/) {
  const std::lock_guard lock(mutex_);
  if (request->stream_id() != open_stream_) {
    return {grpc::NOT_FOUND, "no such stream"};
  }
  for (const v1::Acknowledgement& item : request->items()) {
    acknowledged_ = std::max(acknowledged_, item.seq());
  }
  changed_.notify_all();
  return grpc::Status::OK;
}

void FakeResults::Store(int count) {
  const std::lock_guard lock(mutex_);
  stored_ += count;
  changed_.notify_all();
}

void FakeResults::Cut() {
  const std::lock_guard lock(mutex_);
  ++cuts_;
  changed_.notify_all();
}

void FakeResults::BeginAnew() {
  const std::lock_guard lock(mutex_);
  stored_ = 0;
  ++cuts_;
  changed_.notify_all();
}

void FakeResults::StopListing() {
  const std::lock_guard lock(mutex_);
  listing_ = false;
}

bool FakeResults::WaitForLists(int asked) {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, kPatience, [&] { return lists_ >= asked; });
}

bool FakeResults::WaitForStreams(int opened) {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, kPatience, [&] { return opened_ >= opened; });
}

grpc::Status FakeResults::WatchResults(grpc::ServerContext* context,
                                       const v1::WatchResultsRequest* request,
                                       grpc::ServerWriter<v1::Result>* writer) {
  std::unique_lock lock(mutex_);
  const int cuts = cuts_;
  if (request->after_number() > stored_) return {grpc::OUT_OF_RANGE, "begun anew"};
  uint64_t sent = request->has_after_number() ? request->after_number() : stored_;
  ++opened_;
  changed_.notify_all();
  while (!context->IsCancelled() && cuts_ == cuts) {
    if (sent == stored_) {
      changed_.wait_for(lock, kGlance);
      continue;
    }
    v1::Result result;
    result.set_number(++sent);
    lock.unlock();
    writer->Write(result);
    lock.lock();
  }
  return {grpc::UNAVAILABLE, "going away"};
}

grpc::Status FakeResults::ListResults(grpc::ServerContext* context,
                                      const v1::ListResultsRequest* /*request*/,
                                      v1::ListResultsResponse* response) {
  std::unique_lock lock(mutex_);
  ++lists_;
  changed_.notify_all();
  while (!listing_ && !context->IsCancelled()) changed_.wait_for(lock, kGlance);
  if (stored_ > 0) response->add_results()->set_number(stored_);
  return grpc::Status::OK;
}

grpc::Status FakeSystem::GetServerInfo(grpc::ServerContext* /*context*/,
                                       const v1::GetServerInfoRequest* /*request*/,
                                       v1::GetServerInfoResponse* response) {
  response->set_product("VisionServer");
  // This very clock, 1000 s ahead.
  response->set_monotonic_ns(std::chrono::duration_cast<std::chrono::nanoseconds>(
                                 std::chrono::steady_clock::now().time_since_epoch())
                                 .count() +
                             1'000'000'000'000);
  return grpc::Status::OK;
}

FakeServer::FakeServer(const CertificatePair* certificate, int port) {
  std::shared_ptr<grpc::ServerCredentials> credentials = grpc::InsecureServerCredentials();
  if (certificate != nullptr) {
    grpc::SslServerCredentialsOptions options;
    options.pem_key_cert_pairs.push_back(
        {ReadFile(certificate->key), ReadFile(certificate->certificate)});
    credentials = grpc::SslServerCredentials(options);
  }
  grpc::ServerBuilder builder;
  builder.AddListeningPort("127.0.0.1:" + std::to_string(port), credentials, &port_);
  builder.RegisterService(&streams_);
  builder.RegisterService(&results_);
  builder.RegisterService(&system_);
  server_ = builder.BuildAndStart();
  EXPECT_NE(nullptr, server_);
}

FakeServer::~FakeServer() {
  server_->Shutdown(std::chrono::system_clock::now());
  server_->Wait();
}

}  // namespace vs::test
