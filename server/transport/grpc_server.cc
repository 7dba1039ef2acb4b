#include "server/transport/grpc_server.h"

#include <grpc/impl/codegen/compression_types.h>
#include <grpcpp/generic/async_generic_service.h>
#include <grpcpp/grpcpp.h>
#include <grpcpp/resource_quota.h>
#include <grpcpp/security/tls_certificate_provider.h>
#include <grpcpp/security/tls_credentials_options.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/str.h"
#include "server/rpc/error_details.h"

namespace vs {
namespace {

grpc::ByteBuffer ToByteBuffer(const WireMessage& message) {
  std::vector<grpc::Slice> slices;
  slices.reserve(message.size());
  for (const WireSlice& slice : message) {
    using Owner = std::shared_ptr<const void>;
    slices.emplace_back(
        const_cast<void*>(slice.data), slice.size_bytes,
        [](void* owner) { delete static_cast<Owner*>(owner); }, new Owner(slice.owner));
  }
  return grpc::ByteBuffer(slices.data(), slices.size());
}

std::string ToString(const grpc::ByteBuffer& buffer) {
  std::vector<grpc::Slice> slices;
  std::string bytes;
  if (!buffer.Dump(&slices).ok()) return bytes;
  bytes.reserve(buffer.Length());
  for (const grpc::Slice& slice : slices) {
    bytes.append(reinterpret_cast<const char*>(slice.begin()), slice.size());
  }
  return bytes;
}

grpc::Status ToGrpcStatus(const Status& status) {
  if (status.ok()) return grpc::Status::OK;
  WireError error = ToWireError(status);
  return {static_cast<grpc::StatusCode>(status.code()), error.message, error.details};
}

// Empty when there is none.
std::string_view Metadata(const grpc::CallbackServerContext& context, const char* key) {
  const auto found = context.client_metadata().find(key);
  if (found == context.client_metadata().end()) return {};
  return {found->second.data(), found->second.size()};
}

std::string_view BearerCredential(const grpc::CallbackServerContext& context) {
  static constexpr std::string_view kScheme = "Bearer ";
  const std::string_view value = Metadata(context, "authorization");
  return value.starts_with(kScheme) ? value.substr(kScheme.size()) : std::string_view();
}

// Of "ipv4:10.0.0.7:1234" or "ipv6:%5Bfe80::1%5D:1234".
std::string ClientAddress(const grpc::CallbackServerContext& context) {
  const std::string peer = context.peer();
  std::string host = peer.substr(5, peer.rfind(':') - 5);
  if (host.starts_with("%5B")) host = host.substr(3, host.size() - 6);
  if (host.starts_with('[')) host = host.substr(1, host.size() - 2);
  return host;
}

// gRPC's side of one call; deletes itself when gRPC is done with it.
class Reactor final : public grpc::ServerGenericBidiReactor, public Channel {
 public:
  Reactor(Dispatcher& dispatcher, grpc::GenericCallbackServerContext& context)
      : context_(context),
        call_(dispatcher.Begin(context.method(), BearerCredential(context), ClientAddress(context),
                               *this)) {}

  void OnReadDone(bool ok) override {
    call_->OnRequest(ok ? std::optional(ToString(request_)) : std::nullopt);
  }
  void OnWriteDone(bool ok) override { call_->OnSent(ok); }
  void OnCancel() override { call_->OnCancelled(); }
  void OnDone() override {
    call_->OnDone();
    delete this;
  }

  void Receive() override { StartRead(&request_); }
  void Send(WireMessage message) override {
    response_ = ToByteBuffer(message);
    StartWrite(&response_);
  }
  void SendAndFinish(WireMessage message) override {
    response_ = ToByteBuffer(message);
    StartWriteAndFinish(&response_, grpc::WriteOptions(), grpc::Status::OK);
  }
  void Finish(const Status& status) override {
    grpc::ServerGenericBidiReactor::Finish(ToGrpcStatus(status));
  }
  void Abort() override { context_.TryCancel(); }

 private:
  grpc::GenericCallbackServerContext& context_;
  grpc::ByteBuffer request_;
  grpc::ByteBuffer response_;
  const std::shared_ptr<ServerCall> call_;
};

std::shared_ptr<grpc::ServerCredentials> Credentials(
    const std::optional<CertificateFiles>& certificate) {
  if (!certificate) return grpc::InsecureServerCredentials();
  constexpr unsigned int kReloadS = 1;
  grpc::experimental::TlsServerCredentialsOptions options(
      std::make_shared<grpc::experimental::FileWatcherCertificateProvider>(
          certificate->key.string(), certificate->certificate.string(), kReloadS));
  options.watch_identity_key_cert_pairs();
  options.set_cert_request_type(GRPC_SSL_DONT_REQUEST_CLIENT_CERTIFICATE);
  return grpc::experimental::TlsServerCredentials(options);
}

int Ms(std::chrono::milliseconds time) { return static_cast<int>(time.count()); }

void SetLimits(const GrpcServerOptions& options, grpc::ServerBuilder& builder) {
  builder.SetMaxReceiveMessageSize(options.max_receive_bytes);
  builder.SetMaxSendMessageSize(-1);
  // A few compressed kilobytes could unfold to gigabytes before any limit is looked at.
  builder.SetCompressionAlgorithmSupportStatus(GRPC_COMPRESS_DEFLATE, false);
  builder.SetCompressionAlgorithmSupportStatus(GRPC_COMPRESS_GZIP, false);
  builder.AddChannelArgument(GRPC_ARG_MAX_METADATA_SIZE, options.max_metadata_bytes);
  builder.AddChannelArgument(GRPC_ARG_MAX_CONCURRENT_STREAMS, options.max_streams_per_connection);
  builder.AddChannelArgument(GRPC_ARG_SERVER_HANDSHAKE_TIMEOUT_MS, Ms(options.handshake_timeout));
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIME_MS, Ms(options.keepalive));
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, Ms(options.keepalive) / 2);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_PERMIT_WITHOUT_CALLS, 1);
  builder.AddChannelArgument(GRPC_ARG_HTTP2_MAX_PINGS_WITHOUT_DATA, 0);
  builder.AddChannelArgument(GRPC_ARG_HTTP2_MIN_RECV_PING_INTERVAL_WITHOUT_DATA_MS,
                             Ms(ShortestPingInterval(options.keepalive)));
  grpc::ResourceQuota quota("connections");
  builder.SetResourceQuota(quota.Resize(options.memory_bytes));
}

}  // namespace

std::chrono::milliseconds ShortestPingInterval(std::chrono::milliseconds keepalive) {
  return std::min<std::chrono::milliseconds>(std::chrono::seconds(5), keepalive / 2);
}

class GrpcServer::Impl final : public grpc::CallbackGenericService {
 public:
  explicit Impl(Dispatcher& dispatcher) : dispatcher_(dispatcher) {}
  ~Impl() override { Stop(std::chrono::milliseconds(0)); }

  Status Start(const GrpcServerOptions& options) {
    using Builder = grpc::ServerBuilder;
    if (!options.certificate && !options.acceptor.address.IsLoopback()) {
      return FailedPrecondition(Str(
          "plain text on ", options.acceptor.address.ToString(),
          " would let everybody on the network read passwords: use TLS, or listen on 127.0.0.1"));
    }
    VS_ASSIGN_OR_RETURN(listener_, Acceptor::Listen(options.acceptor));
    Builder builder;
    SetLimits(options, builder);
    builder.RegisterCallbackGenericService(this);
    // Belongs to the builder's server once that is there.
    std::unique_ptr<grpc::experimental::ExternalConnectionAcceptor> entry =
        builder.experimental().AddExternalConnectionAcceptor(
            Builder::experimental_type::ExternalConnectionType::FROM_FD,
            Credentials(options.certificate));
    server_ = builder.BuildAndStart();
    if (!server_) return Internal("gRPC cannot start; the log above says why");
    entry_ = std::move(entry);
    return Status();
  }

  void TakeConnections() {
    listener_->Start([this](int fd, const std::string& /*address*/) {
      grpc::experimental::ExternalConnectionAcceptor::NewConnectionParameters connection;
      connection.fd = fd;
      entry_->HandleNewConnection(&connection);
    });
  }

  void Stop(std::chrono::milliseconds patience) {
    if (listener_) listener_->Stop();
    if (!server_) return;
    server_->Shutdown(std::chrono::system_clock::now() + patience);
    server_->Wait();
  }

  const Acceptor& listener() const { return *listener_; }

 private:
  grpc::ServerGenericBidiReactor* CreateReactor(
      grpc::GenericCallbackServerContext* context) override {
    return new Reactor(dispatcher_, *context);
  }

  Dispatcher& dispatcher_;
  std::unique_ptr<Acceptor> listener_;
  std::unique_ptr<grpc::experimental::ExternalConnectionAcceptor> entry_;
  std::unique_ptr<grpc::Server> server_;
};

Result<std::unique_ptr<GrpcServer>> GrpcServer::Start(const GrpcServerOptions& options,
                                                      Dispatcher& dispatcher) {
  auto impl = std::make_unique<Impl>(dispatcher);
  VS_RETURN_IF_ERROR(impl->Start(options));
  return std::unique_ptr<GrpcServer>(new GrpcServer(std::move(impl)));
}

GrpcServer::GrpcServer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
GrpcServer::~GrpcServer() = default;

void GrpcServer::TakeConnections() { impl_->TakeConnections(); }
uint16_t GrpcServer::port() const { return impl_->listener().port(); }
Acceptor::Stats GrpcServer::Connections() const { return impl_->listener().GetStats(); }
void GrpcServer::Stop(std::chrono::milliseconds patience) { impl_->Stop(patience); }

}  // namespace vs
