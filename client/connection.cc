#include "client/connection.h"

#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>
#include <grpcpp/support/channel_arguments.h>

#include <utility>

#include "visionserver/v1/error.pb.h"

#include "client/address.h"
#include "client/certificate.h"

namespace vs::client {
namespace {

using std::chrono::milliseconds;

// Raw depth of two megapixels takes 8 MB; nothing sensible is larger than this.
constexpr int kMaxMessageBytes = 64 << 20;
constexpr milliseconds kFirstPause{200};
constexpr milliseconds kLongestPause{5000};

int Count(milliseconds time) { return static_cast<int>(time.count()); }

grpc::ChannelArguments Arguments(const ConnectOptions& options) {
  grpc::ChannelArguments arguments;
  arguments.SetMaxReceiveMessageSize(kMaxMessageBytes);
  arguments.SetUserAgentPrefix("visionserver-cpp/1");
  arguments.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, Count(kFirstPause));
  arguments.SetInt(GRPC_ARG_MIN_RECONNECT_BACKOFF_MS, Count(options.connect_timeout));
  arguments.SetInt(GRPC_ARG_MAX_RECONNECT_BACKOFF_MS, Count(kLongestPause));
  arguments.SetInt(GRPC_ARG_KEEPALIVE_TIME_MS, Count(options.keepalive));
  arguments.SetInt(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, Count(options.keepalive) / 2);
  arguments.SetInt(GRPC_ARG_HTTP2_MAX_PINGS_WITHOUT_DATA, 0);
  // A vision server is near; a proxy for the web is not on the way to it.
  arguments.SetInt(GRPC_ARG_ENABLE_HTTP_PROXY, 0);
  // Two clients of one program are two connections, so that one's pictures do not delay the other.
  arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
  return arguments;
}

std::shared_ptr<grpc::ChannelCredentials> TlsCredentials(std::string roots_pem) {
  grpc::SslCredentialsOptions ssl;
  ssl.pem_root_certs = std::move(roots_pem);
  return grpc::SslCredentials(ssl);
}

tl::unexpected<Error> Mismatch(const Address& address, const std::string& expected,
                               const std::string& shown) {
  return Failure(Code::kUnavailable,
                 "the certificate of " + address.ToString() + " has the fingerprint " + shown +
                     ", expected was " + expected +
                     "; if the server was given a new certificate, take over the fingerprint that "
                     "it prints when it starts, otherwise somebody pretends to be it",
                 "CERTIFICATE_MISMATCH");
}

// What keeps gRPC, which says little about it, from connecting.
Error Diagnose(const Address& address, const ConnectOptions& options, const std::string& roots) {
  if (!options.plaintext) {
    const Result<ServerCertificate> shown =
        FetchCertificate(address, roots, options.connect_timeout);
    if (!shown) return shown.error();
    if (!shown->distrust.empty()) {
      return Failure(
                 Code::kUnavailable,
                 "the certificate of " + address.ToString() + " is not trusted: " +
                     shown->distrust + "; give the server's certificate file, or its " +
                     "fingerprint if it is the one that the server printed: " + shown->fingerprint,
                 "CERTIFICATE_UNTRUSTED")
          .value();
    }
  }
  return Failure(Code::kUnavailable,
                 "no server answers at " + address.ToString() +
                     ": is it running, and was it started with" +
                     (options.plaintext ? "out TLS?" : " TLS?"),
                 "CONNECTION_FAILED")
      .value();
}

bool WaitUntilReady(grpc::Channel& channel, milliseconds timeout) {
  const auto deadline = std::chrono::system_clock::now() + timeout;
  for (;;) {
    const grpc_connectivity_state state = channel.GetState(true);
    if (state == GRPC_CHANNEL_READY) return true;
    // gRPC would go on trying; but what fails once is worth telling now.
    if (state == GRPC_CHANNEL_TRANSIENT_FAILURE) return false;
    if (!channel.WaitForStateChange(state, deadline)) return false;
  }
}

}  // namespace

Connection::Connection(ConnectOptions options, std::shared_ptr<grpc::Channel> channel)
    : options_(std::move(options)),
      channel_(std::move(channel)),
      credential_(options_.credential) {}

Result<std::shared_ptr<Connection>> Connection::Open(const ConnectOptions& options) {
  const Result<Address> address = ParseAddress(options.address);
  if (!address) return tl::unexpected(address.error());
  grpc::ChannelArguments arguments = Arguments(options);
  std::shared_ptr<grpc::ChannelCredentials> credentials;
  std::string roots;
  if (options.plaintext) {
    if (!address->IsLoopback()) {
      return Failure(Code::kInvalidArgument,
                     "plain text to " + address->ToString() +
                         " would show passwords to the network; use TLS, or connect on the "
                         "server's own machine");
    }
    credentials = grpc::InsecureChannelCredentials();
  } else if (!options.fingerprint.empty()) {
    const Result<std::string> expected = NormalizeFingerprint(options.fingerprint);
    if (!expected) return tl::unexpected(expected.error());
    const Result<ServerCertificate> shown = FetchCertificate(*address, {}, options.connect_timeout);
    if (!shown) return tl::unexpected(shown.error());
    if (shown->fingerprint != *expected) return Mismatch(*address, *expected, shown->fingerprint);
    // This very certificate is the root, so any name that it carries identifies the server.
    roots = shown->pem;
    credentials = TlsCredentials(roots);
    if (!shown->names.empty()) arguments.SetSslTargetNameOverride(shown->names.front());
  } else {
    const Result<std::string> read = ReadRoots(options.ca_file);
    if (!read) return tl::unexpected(read.error());
    roots = *read;
    credentials = TlsCredentials(roots);
  }
  auto channel = grpc::CreateCustomChannel(address->ToString(), credentials, arguments);
  if (!WaitUntilReady(*channel, options.connect_timeout)) {
    return tl::unexpected(Diagnose(*address, options, roots));
  }
  return std::shared_ptr<Connection>(new Connection(options, std::move(channel)));
}

void Connection::SetCredential(std::string credential) {
  const std::lock_guard lock(mutex_);
  credential_ = std::move(credential);
}

void Connection::Prepare(grpc::ClientContext& context, std::optional<milliseconds> timeout) const {
  if (timeout) context.set_deadline(std::chrono::system_clock::now() + *timeout);
  const std::lock_guard lock(mutex_);
  if (!credential_.empty()) context.AddMetadata("authorization", "Bearer " + credential_);
}

Error ToError(const grpc::Status& status) {
  Error error{.code = static_cast<Code>(status.error_code()),
              .message = status.error_message(),
              .reason = std::string(CodeName(static_cast<Code>(status.error_code()))),
              .faults = {}};
  if (status.error_details().empty()) {
    // Not the server's words but gRPC's.
    if (error.code == Code::kUnavailable) {
      error.message = "the connection to the server is lost (" + error.message + ")";
    } else if (error.code == Code::kDeadlineExceeded) {
      error.message = "the server did not answer in time";
    }
  }
  visionserver::v1::ErrorStatus details;
  if (!details.ParseFromString(status.error_details())) return error;
  for (const google::protobuf::Any& any : details.details()) {
    visionserver::v1::ErrorDetail detail;
    if (!any.UnpackTo(&detail)) continue;
    if (!detail.reason().empty()) error.reason = detail.reason();
    for (const auto& fault : detail.faults()) {
      error.faults.push_back({.subject = fault.subject(), .message = fault.message()});
    }
  }
  return error;
}

}  // namespace vs::client
