#include "client/cli/session.h"

#include <unistd.h>

#include <array>
#include <cstdlib>
#include <utility>

#include "client/address.h"

namespace vs::cli {
namespace {

using client::Result;

std::string Environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

std::string FirstGiven(std::initializer_list<std::string> candidates) {
  for (const std::string& candidate : candidates) {
    if (!candidate.empty()) return candidate;
  }
  return {};
}

std::string ClientName() {
  std::array<char, 256> host{};
  if (::gethostname(host.data(), host.size() - 1) != 0) return "visionctl";
  return std::string("visionctl on ") + host.data();
}

}  // namespace

Session::Session(GlobalOptions options) : options_(std::move(options)) {}

std::chrono::milliseconds Session::timeout() const {
  return std::chrono::milliseconds(static_cast<int64_t>(options_.timeout_s * 1000));
}

Result<client::Client*> Session::Connect() { return Open(true); }

Result<client::Client*> Session::ConnectWithoutLogin() { return Open(false); }

Result<client::Client*> Session::Open(bool with_login) {
  if (client_) return client_.get();
  const Result<Credentials> stored = LoadCredentials();
  if (!stored) return tl::unexpected(stored.error());
  const Result<client::Address> address = client::ParseAddress(FirstGiven(
      {options_.server, Environment("VISIONSERVER_ADDRESS"), stored->current, "localhost"}));
  if (!address) return tl::unexpected(address.error());

  client::ConnectOptions& to = connected_to_;
  to.address = address->ToString();
  to.ca_file = FirstGiven({options_.ca_file, Environment("VISIONSERVER_CA")});
  to.fingerprint = FirstGiven({options_.fingerprint, Environment("VISIONSERVER_FINGERPRINT")});
  to.plaintext = options_.plaintext;
  to.client_name = ClientName();
  to.call_timeout = timeout();
  std::string token;
  if (const auto known = stored->servers.find(to.address); known != stored->servers.end()) {
    if (to.ca_file.empty() && to.fingerprint.empty() && !to.plaintext) {
      to.ca_file = known->second.ca_file;
      to.fingerprint = known->second.fingerprint;
      to.plaintext = known->second.plaintext;
    }
    token = known->second.token;
  }
  if (with_login) to.credential = FirstGiven({Environment("VISIONSERVER_TOKEN"), token});

  Result<std::unique_ptr<client::Client>> connected = client::Client::Connect(to);
  if (!connected) return tl::unexpected(connected.error());
  client_ = std::move(*connected);
  return client_.get();
}

Result<void> Session::Remember(const std::string& user, const std::string& token) {
  Result<Credentials> stored = LoadCredentials();
  if (!stored) return tl::unexpected(stored.error());
  stored->current = connected_to_.address;
  stored->servers[connected_to_.address] = {.user = user,
                                            .token = token,
                                            .ca_file = connected_to_.ca_file,
                                            .fingerprint = connected_to_.fingerprint,
                                            .plaintext = connected_to_.plaintext};
  return SaveCredentials(*stored);
}

Result<void> Session::Forget() {
  Result<Credentials> stored = LoadCredentials();
  if (!stored) return tl::unexpected(stored.error());
  const auto known = stored->servers.find(connected_to_.address);
  if (known == stored->servers.end()) return {};
  known->second.token.clear();
  return SaveCredentials(*stored);
}

}  // namespace vs::cli
