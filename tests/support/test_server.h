#pragma once

#include <memory>
#include <string>

#include "engine/base/clock.h"
#include "server/access/caller.h"
#include "server/server.h"
#include "tests/support/temp_folder.h"

namespace grpc {
class Channel;
}

namespace vs::test {

struct TestServerOptions {
  bool tls = false;
  // More lines for the configuration file, such as "limits { connections: 5 }".
  std::string config;
  // For sessions and throttling; the machine's if null.
  const Clock* clock = nullptr;
};

// A whole server in this process, on a free port of this machine, with data of its own and cheap
// password hashing. A server that does not start fails the test by an exception.
class TestServer {
 public:
  explicit TestServer(TestServerOptions options = {});

  Server& operator*() { return *server_; }
  Server* operator->() { return server_.get(); }

  // Stops it and starts it again on the same data (and another port).
  void Restart();

  // A connection of its own to the server.
  std::shared_ptr<grpc::Channel> Connect() const;
  // "ipv4:127.0.0.1:PORT"
  std::string Target() const;
  std::filesystem::path data_dir() const { return folder_ / "data"; }

  // A valid token of somebody with this role: of a new login each time, or of the one robot's key.
  std::string Token(Role role);
  // Adds a user whose password is kPassword.
  void AddUser(const std::string& name, Role role);
  static constexpr const char* kPassword = "correct horse battery";

 private:
  void Start();

  const TestServerOptions options_;
  TempFolder folder_;
  std::string robot_key_;
  std::unique_ptr<Server> server_;
};

}  // namespace vs::test
