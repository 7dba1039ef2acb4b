#include "tests/support/test_server.h"

#include <grpcpp/grpcpp.h>

#include <atomic>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "engine/base/str.h"

namespace vs::test {
namespace {

template <class T>
T OrThrow(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().ToString());
  return std::move(*result);
}

void OrThrow(const Status& status) {
  if (!status.ok()) throw std::runtime_error(status.ToString());
}

}  // namespace

TestServer::TestServer(TestServerOptions options) : options_(std::move(options)) { Start(); }

void TestServer::Start() {
  const std::string text = Str("data_dir: \"data\"\nlisten_address: \"127.0.0.1:0\"\n",
                               options_.tls ? "" : "plaintext: true\n", options_.config);
  server_ =
      OrThrow(Server::Start({.config = OrThrow(ParseConfig(text, "test.conf", folder_.path())),
                             .password_cost = {.passes = 1, .memory_bytes = 8192},
                             .clock = options_.clock}));
}

void TestServer::Restart() {
  server_.reset();
  Start();
}

std::string TestServer::Target() const { return Str("ipv4:127.0.0.1:", server_->port()); }

std::shared_ptr<grpc::Channel> TestServer::Connect() const {
  std::shared_ptr<grpc::ChannelCredentials> credentials = grpc::InsecureChannelCredentials();
  grpc::ChannelArguments arguments;
  if (options_.tls) {
    std::ifstream file(data_dir() / "tls" / "server.crt");
    credentials =
        grpc::SslCredentials({.pem_root_certs = {std::istreambuf_iterator<char>(file), {}}});
    arguments.SetSslTargetNameOverride("localhost");
  }
  // Channels with equal arguments share a connection; a number makes them differ.
  static std::atomic<int> number{0};
  arguments.SetInt("test.connection", ++number);
  return grpc::CreateCustomChannel(Target(), credentials, arguments);
}

void TestServer::AddUser(const std::string& name, Role role) {
  Accounts& accounts = server_->access().accounts();
  const std::string one_time = OrThrow(accounts.CreateUser({.name = name, .role = role}));
  OrThrow(accounts.ChangePassword(name, one_time, kPassword));
}

std::string TestServer::Token(Role role) {
  if (role == Role::kRobot) {
    if (robot_key_.empty()) {
      robot_key_ =
          OrThrow(server_->access().accounts().CreateApiKey({.name = "test robot"})).secret;
    }
    return robot_key_;
  }
  const std::string name = Str("test.", RoleName(role));
  if (!server_->access().accounts().FindUser(name)) AddUser(name, role);
  return OrThrow(server_->access().LogIn(name, kPassword, "127.0.0.1", "a test")).token;
}

}  // namespace vs::test
