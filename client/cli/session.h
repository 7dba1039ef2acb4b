#pragma once

#include <chrono>
#include <memory>
#include <string>

#include "client/cli/credentials.h"
#include "client/client.h"

namespace vs::cli {

// What stands on the command line for every command.
struct GlobalOptions {
  std::string server;
  std::string ca_file;
  std::string fingerprint;
  bool plaintext = false;
  bool json = false;
  double timeout_s = 15;
};

// One run of visionctl: where it connects to and how it prints.
class Session {
 public:
  explicit Session(GlobalOptions options);

  const GlobalOptions& options() const { return options_; }
  // How long to wait for an answer.
  std::chrono::milliseconds timeout() const;

  // Connects at the first call. What the command line leaves open comes from the environment, then
  // from the last login.
  client::Result<client::Client*> Connect();
  // The same server, but nobody logged in.
  client::Result<client::Client*> ConnectWithoutLogin();

  // Stores the login of the server that is connected, and makes it the one that later commands use.
  client::Result<void> Remember(const std::string& user, const std::string& token);
  // Forgets the login of that server.
  client::Result<void> Forget();

 private:
  client::Result<client::Client*> Open(bool with_login);

  const GlobalOptions options_;
  client::ConnectOptions connected_to_;
  std::unique_ptr<client::Client> client_;
};

}  // namespace vs::cli
