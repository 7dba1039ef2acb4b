#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "engine/base/clock.h"
#include "engine/base/mutex.h"
#include "engine/base/status.h"
#include "server/access/access_control.h"
#include "server/access/password.h"
#include "server/audit/audit_log.h"
#include "server/config/config.h"
#include "server/data_folder.h"
#include "server/http/http_server.h"
#include "server/rpc/dispatcher.h"
#include "server/rpc/router.h"
#include "server/services/alarm_board.h"
#include "server/services/audit_service.h"
#include "server/services/health_board.h"
#include "server/services/health_service.h"
#include "server/services/reflection_service.h"
#include "server/services/session_service.h"
#include "server/services/system_service.h"
#include "server/services/user_service.h"
#include "server/transport/grpc_server.h"
#include "server/vision.h"
#include "server/vision_watch.h"

namespace vs {

struct ServerOptions {
  config::ServerConfig config;
  PasswordCost password_cost;  // less only in tests
  // Gives the user "admin" a new one-time password.
  bool rescue_admin = false;
  // Folder of the page's files, "" for none.
  std::filesystem::path web_root;
  // For sessions and throttling; the machine's clock if null. Must outlive the server.
  const Clock* clock = nullptr;
};

// A whole server: makes the parts, hands them to each other, and takes them apart again.
class Server {
 public:
  // Takes connections when it returns.
  static Result<std::unique_ptr<Server>> Start(const ServerOptions& options);
  // Without grace; see Drain.
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  // Ends gracefully, within nine seconds unless a call or a block cannot be stopped: health says
  // NOT_SERVING, new calls and streams are refused, sequences stop, their results reach the disk,
  // and what is being worked on comes to its end.
  void Drain();

  // Stores the last use of sessions and looks at the certificate. Calls itself once a minute.
  void LookAround();

  // "127.0.0.1:50051": where it listens, with the port that it really got.
  std::string address() const;
  uint16_t port() const { return grpc_->port(); }
  // Of the page, "https://127.0.0.1:8443/", with the port that it really got and this machine's
  // name where it listens on all its addresses; empty when there is none.
  std::string PageAddress() const;
  // SHA-256 of its certificate; empty without TLS.
  const std::string& fingerprint() const { return fingerprint_; }
  // To log in as "admin", once; nothing when somebody has already. Told nowhere else.
  const std::optional<std::string>& one_time_password() const { return one_time_password_; }

  AccessControl& access() { return *access_; }
  HealthBoard& health() { return health_; }
  AuditLog& audit() { return *audit_; }
  AlarmBoard& alarms() { return alarms_; }
  const Dispatcher& dispatcher() const { return *dispatcher_; }
  GrpcServer& grpc() { return *grpc_; }
  // Null when the configuration has no web_address.
  HttpServer* http() { return http_.get(); }
  Vision& vision() { return *vision_; }

 private:
  Server(const ServerOptions& options, DataFolder folder);
  Status OpenStores();
  Result<std::unique_ptr<AuditLog>> OpenAudit();
  void RegisterServices();
  Status StartNetwork();
  Status StartPage();
  Acceptor::Stats Connections() const;
  void LookAtCertificate();
  void KeepHouse() VS_EXCLUDES(mutex_);

  const ServerOptions options_;
  const config::ServerConfig& config_;
  const SystemClock system_clock_;
  const Clock& clock_;
  const DataFolder folder_;
  std::string fingerprint_;
  std::optional<std::string> one_time_password_;

  // What is stored and known.
  HealthBoard health_;
  AlarmBoard alarms_;
  std::unique_ptr<AccessControl> access_;
  std::unique_ptr<AuditLog> audit_;
  std::unique_ptr<Vision> vision_;
  std::unique_ptr<VisionWatch> vision_watch_;

  // What answers calls. They go before the parts above.
  std::unique_ptr<SessionService> session_service_;
  std::unique_ptr<UserService> user_service_;
  std::unique_ptr<AuditService> audit_service_;
  std::unique_ptr<SystemService> system_service_;
  std::unique_ptr<HealthService> health_service_;
  std::unique_ptr<ReflectionService> reflection_service_;
  Router router_;

  // What brings calls. It goes before the parts above.
  std::unique_ptr<Dispatcher> dispatcher_;
  std::unique_ptr<GrpcServer> grpc_;
  std::unique_ptr<HttpServer> http_;

  std::optional<CertificateFiles> certificate_;
  Mutex mutex_;
  CondVar changed_;
  bool closing_ VS_GUARDED_BY(mutex_) = false;
  std::jthread housekeeper_;
};

}  // namespace vs
