#include "server/server.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <set>
#include <thread>
#include <utility>

#include "engine/base/check.h"
#include "engine/base/log.h"
#include "engine/base/str.h"
#include "gpu/devices.h"
#include "server/access/policy.h"
#include "server/version.h"

namespace vs {
namespace {

using std::chrono::milliseconds;

constexpr int64_t kMinuteNs = int64_t{60} * 1'000'000'000;
constexpr int64_t kDayNs = kMinuteNs * 60 * 24;
// A graceful end. The steps share the whole; the last bytes have their part for sure.
constexpr milliseconds kGrace{9000};
constexpr milliseconds kAnnouncement{200};
constexpr milliseconds kLastBytes{1000};

// A method that nobody decided about must not be reachable.
void CheckPolicyIsComplete(const Router& router) {
  for (const auto& [name, method] : router.methods()) {
    if (FindAccessRule(name) != nullptr) continue;
    LogError("server", Str(name, " is missing in the table of rights (server/access/policy.cc)"));
    VS_CHECK(FindAccessRule(name) != nullptr);
  }
}

AccessOptions ToAccessOptions(const config::ServerConfig& config, const DataFolder& folder,
                              const PasswordCost& cost) {
  const config::Sessions& sessions = config.sessions();
  return {.database = folder.path() / "users.db",
          .sessions = {.idle_ns = sessions.idle_minutes() * kMinuteNs,
                       .lifetime_ns = sessions.lifetime_minutes() * kMinuteNs,
                       .per_user = static_cast<size_t>(sessions.per_user()),
                       .total = static_cast<size_t>(sessions.total())},
          .password_cost = cost};
}

DispatcherOptions ToDispatcherOptions(const config::Limits& limits) {
  DispatcherOptions options;
  options.max_open_streams = limits.open_streams();
  options.max_streams_per_session = limits.streams_per_session();
  options.unread.silence = milliseconds(limits.unread_ms());
  return options;
}

GrpcServerOptions ToGrpcOptions(const config::Limits& limits, ListenAddress address) {
  return {.acceptor = {.address = std::move(address),
                       .max_connections = limits.connections(),
                       .max_connections_per_address = limits.connections_per_address()},
          .handshake_timeout = milliseconds(limits.handshake_ms()),
          .keepalive = milliseconds(limits.keepalive_ms()),
          .max_streams_per_connection = limits.streams_per_connection(),
          .max_receive_bytes = limits.request_kib() << 10,
          .memory_bytes = static_cast<size_t>(limits.receive_memory_mib()) << 20};
}

HttpServerOptions ToHttpOptions(const config::ServerConfig& config, ListenAddress address) {
  const config::Limits& limits = config.limits();
  const config::WebLimits& web = config.web_limits();
  const milliseconds keepalive(limits.keepalive_ms());
  const milliseconds unread(limits.unread_ms());
  return {.acceptor = {.address = std::move(address),
                       .max_connections = web.connections(),
                       .max_connections_per_address = web.connections_per_address(),
                       .keepalive = keepalive,
                       .vanished = std::max({2 * keepalive, 2 * unread, milliseconds(60'000)})},
          .limits = {
              .handshake = milliseconds(limits.handshake_ms()),
              .head = milliseconds(web.head_ms()),
              .idle = milliseconds(web.idle_ms()),
              .calls = {.request_bytes = static_cast<size_t>(limits.request_kib()) << 10,
                        .request_time = milliseconds(web.body_ms()),
                        .unread = {.silence = unread},
                        .memory_bytes = static_cast<size_t>(limits.receive_memory_mib()) << 20}}};
}

}  // namespace

Result<std::unique_ptr<Server>> Server::Start(const ServerOptions& options) {
  VS_ASSIGN_OR_RETURN(DataFolder folder, DataFolder::Take(options.config.data_dir()));
  gpu::RegisterMatchers();
  std::unique_ptr<Server> server(new Server(options, std::move(folder)));
  VS_RETURN_IF_ERROR(server->OpenStores());
  server->RegisterServices();
  VS_RETURN_IF_ERROR(server->StartNetwork());
  server->vision_->StartSequences();
  server->vision_watch_ = std::make_unique<VisionWatch>(
      *server->vision_, gpu::Board(), server->health_, server->alarms_, server->system_clock_);
  server->housekeeper_ = std::jthread([raw = server.get()] { raw->KeepHouse(); });
  return server;
}

Server::Server(const ServerOptions& options, DataFolder folder)
    : options_(options),
      config_(options_.config),
      clock_(options.clock != nullptr ? *options.clock : system_clock_),
      folder_(std::move(folder)),
      alarms_(clock_) {}

Server::~Server() {
  {
    MutexLock lock(mutex_);
    closing_ = true;
  }
  changed_.NotifyAll();
  if (housekeeper_.joinable()) housekeeper_.join();
  if (dispatcher_) dispatcher_->Drain();
  if (http_) http_->Stop(milliseconds(0));
  if (grpc_) grpc_->Stop(milliseconds(0));
}

Status Server::OpenStores() {
  VS_ASSIGN_OR_RETURN(
      access_,
      AccessControl::Open(ToAccessOptions(config_, folder_, options_.password_cost), clock_));
  if (options_.rescue_admin) {
    VS_ASSIGN_OR_RETURN(one_time_password_, access_->accounts().RescueAdmin());
  } else {
    VS_ASSIGN_OR_RETURN(one_time_password_, access_->accounts().FirstPassword());
  }
  VS_ASSIGN_OR_RETURN(audit_, OpenAudit());
  VS_ASSIGN_OR_RETURN(vision_, Vision::Open(config_, folder_.path(), system_clock_));
  return Status();
}

Result<std::unique_ptr<AuditLog>> Server::OpenAudit() {
  const auto is_user = [this](const std::string& name) {
    return access_->accounts().FindUser(name).has_value();
  };
  const auto on_state = [this](const Status& status) {
    if (status.ok()) {
      alarms_.Clear("audit");
    } else {
      alarms_.Raise(
          "audit", AlarmBoard::Severity::kError,
          Str("who changes what is not written down, but waits in memory: ", status.message()));
    }
  };
  return AuditLog::Open({.file = folder_.path() / "audit.db",
                         .limits = {.keep_ns = config_.audit().keep_days() * kDayNs,
                                    .keep_entries = config_.audit().keep_entries()},
                         .is_user = is_user,
                         .on_state = on_state},
                        clock_);
}

void Server::RegisterServices() {
  session_service_ = std::make_unique<SessionService>(*access_);
  user_service_ = std::make_unique<UserService>(*access_);
  audit_service_ = std::make_unique<AuditService>(audit_->store());
  system_service_ = std::make_unique<SystemService>(
      SystemServiceOptions{.name = config_.name(), .version = kVersion, .data_dir = folder_.path()},
      clock_, *access_, alarms_);
  health_service_ = std::make_unique<HealthService>(health_);
  session_service_->Register(router_);
  user_service_->Register(router_);
  audit_service_->Register(router_);
  system_service_->Register(router_);
  health_service_->Register(router_);
  vision_->Register(router_);
  if (config_.profile() == config::ServerConfig::DEVELOPMENT) {
    reflection_service_ = std::make_unique<ReflectionService>();
    reflection_service_->Register(router_);
  }
  CheckPolicyIsComplete(router_);
}

Status Server::StartNetwork() {
  VS_ASSIGN_OR_RETURN(ListenAddress address, ListenAddress::Parse(config_.listen_address()));
  GrpcServerOptions options = ToGrpcOptions(config_.limits(), std::move(address));
  if (!config_.plaintext()) {
    if (config_.has_tls_certificate()) {
      options.certificate = {.certificate = config_.tls_certificate(), .key = config_.tls_key()};
    } else {
      VS_ASSIGN_OR_RETURN(options.certificate, EnsureCertificate(folder_.path() / "tls"));
    }
    VS_ASSIGN_OR_RETURN(const CertificateInfo info, CheckCertificate(*options.certificate));
    fingerprint_ = info.fingerprint;
    certificate_ = options.certificate;
  }
  dispatcher_ = std::make_unique<Dispatcher>(router_, *access_,
                                             ToDispatcherOptions(config_.limits()), audit_.get());
  VS_ASSIGN_OR_RETURN(grpc_, GrpcServer::Start(options, *dispatcher_));
  if (!config_.web_address().empty()) VS_RETURN_IF_ERROR(StartPage());
  system_service_->Attach(*dispatcher_, [this] { return Connections(); });
  grpc_->TakeConnections();
  if (http_) http_->TakeConnections();
  return Status();
}

Status Server::StartPage() {
  Result<ListenAddress> address = ListenAddress::Parse(config_.web_address());
  if (!address) return address.error().Annotated("web_address");
  HttpServerOptions options = ToHttpOptions(config_, std::move(*address));
  options.certificate = certificate_;
  options.web_root = options_.web_root;
  Result<std::unique_ptr<HttpServer>> started = HttpServer::Start(options, *dispatcher_);
  if (!started) {
    return started.error().Annotated(
        "the page (web_address chooses another address, --no-web none)");
  }
  http_ = std::move(*started);
  return Status();
}

Acceptor::Stats Server::Connections() const {
  Acceptor::Stats all = grpc_->Connections();
  if (!http_) return all;
  const Acceptor::Stats page = http_->Connections();
  all.open += page.open;
  all.accepted += page.accepted;
  all.refused += page.refused;
  return all;
}

void Server::Drain() {
  const Deadline end(system_clock_, kGrace);
  health_.Drain();
  // Whoever watches the health sees it before the streams end.
  std::this_thread::sleep_for(kAnnouncement);
  dispatcher_->Drain();
  // First what must not be lost, whatever the calls do.
  vision_->Close(end);
  while (!dispatcher_->Idle() && end.Left() > kLastBytes) {
    std::this_thread::sleep_for(milliseconds(10));
  }
  if (http_) http_->Stop(end.Left());
  grpc_->Stop(end.Left());
}

void Server::KeepHouse() {
  while (true) {
    LookAround();
    MutexLock lock(mutex_);
    if (!closing_) changed_.WaitFor(mutex_, std::chrono::minutes(1));
    if (closing_) return;
  }
}

void Server::LookAround() {
  if (const Status stored = access_->sessions().StoreLastUse(); !stored.ok()) {
    LogWarn("access", Str("the last use of sessions is not stored: ", stored.message()));
  }
  if (certificate_) LookAtCertificate();
}

void Server::LookAtCertificate() {
  const Result<CertificateInfo> info = CheckCertificate(*certificate_);
  if (info && info->not_after_utc_ns >= clock_.UtcNs() + 30 * kDayNs) {
    alarms_.Clear("certificate");
    return;
  }
  alarms_.Raise("certificate", AlarmBoard::Severity::kWarning,
                info ? Str(certificate_->certificate.string(),
                           " ends within 30 days, or has ended; put a new one in its place")
                     : info.error().message());
}

std::string Server::address() const {
  // Parsed when the network was started.
  ListenAddress address = *ListenAddress::Parse(config_.listen_address());
  address.port = grpc_->port();
  return address.ToString();
}

std::string Server::PageAddress() const {
  if (!http_) return "";
  ListenAddress address = *ListenAddress::Parse(config_.web_address());
  address.port = http_->port();
  std::array<char, 256> host{};
  const bool everywhere = address.host == "0.0.0.0" || address.host == "::";
  if (everywhere && ::gethostname(host.data(), host.size() - 1) == 0) address.host = host.data();
  return Str(config_.plaintext() ? "http://" : "https://", address.ToString(), '/');
}

}  // namespace vs
