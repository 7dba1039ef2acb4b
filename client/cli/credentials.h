#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "client/error.h"

namespace vs::cli {

// What is kept of a login: how the server is known, and the token that stands for the password.
struct ServerLogin {
  std::string user;
  std::string token;  // empty after logout
  std::string ca_file;
  std::string fingerprint;
  bool plaintext = false;

  bool operator==(const ServerLogin&) const = default;
};

struct Credentials {
  std::string current;                         // the server of the last login, "host:port"
  std::map<std::string, ServerLogin> servers;  // by "host:port"
};

// $XDG_CONFIG_HOME/visionserver/credentials.json, or the same under ~/.config.
std::filesystem::path CredentialsFile();

// Nothing stored gives empty ones. FAILED_PRECONDITION when others than its owner may read the
// file, or when it is damaged.
client::Result<Credentials> LoadCredentials();

// Replaces the file at once; folder and file are for their owner only.
client::Result<void> SaveCredentials(const Credentials& credentials);

}  // namespace vs::cli
