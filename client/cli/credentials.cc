#include "client/cli/credentials.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>

#include <nlohmann/json.hpp>

namespace vs::cli {
namespace {

using client::Code;
using client::Failure;
using client::Result;
using nlohmann::json;

tl::unexpected<client::Error> Cannot(const std::string& verb, const std::filesystem::path& path) {
  return Failure(Code::kFailedPrecondition,
                 "cannot " + verb + " " + path.string() + ": " + std::strerror(errno));
}

bool WriteAll(int fd, const std::string& text) {
  size_t done = 0;
  while (done < text.size()) {
    const ssize_t wrote = ::write(fd, text.data() + done, text.size() - done);
    if (wrote < 0 && errno != EINTR) return false;
    if (wrote > 0) done += static_cast<size_t>(wrote);
  }
  return ::fsync(fd) == 0;
}

}  // namespace

std::filesystem::path CredentialsFile() {
  std::filesystem::path base;
  if (const char* config = std::getenv("XDG_CONFIG_HOME"); config != nullptr && *config != '\0') {
    base = config;
  } else if (const char* home = std::getenv("HOME"); home != nullptr) {
    base = std::filesystem::path(home) / ".config";
  }
  return base / "visionserver" / "credentials.json";
}

Result<Credentials> LoadCredentials() {
  const std::filesystem::path path = CredentialsFile();
  struct stat facts {};
  if (::stat(path.c_str(), &facts) != 0) {
    if (errno == ENOENT || errno == ENOTDIR) return Credentials();
    return Cannot("read", path);
  }
  if ((facts.st_mode & (S_IRWXG | S_IRWXO)) != 0) {
    return Failure(Code::kFailedPrecondition,
                   "others may read the login stored in " + path.string() +
                       "; say chmod 600 to it, and log in again if somebody may have");
  }
  std::ifstream file(path);
  const json root = json::parse(file, nullptr, false);
  Credentials credentials;
  try {
    credentials.current = root.at("current").get<std::string>();
    for (const auto& [address, login] : root.at("servers").items()) {
      credentials.servers[address] = {.user = login.at("user").get<std::string>(),
                                      .token = login.at("token").get<std::string>(),
                                      .ca_file = login.at("ca").get<std::string>(),
                                      .fingerprint = login.at("fingerprint").get<std::string>(),
                                      .plaintext = login.at("plaintext").get<bool>()};
    }
  } catch (const json::exception&) {
    return Failure(Code::kFailedPrecondition,
                   path.string() + " is damaged; remove it and log in again");
  }
  return credentials;
}

Result<void> SaveCredentials(const Credentials& credentials) {
  const std::filesystem::path path = CredentialsFile();
  std::error_code error;
  std::filesystem::create_directories(path.parent_path(), error);
  if (::chmod(path.parent_path().c_str(), S_IRWXU) != 0) return Cannot("use", path.parent_path());
  json root = {{"current", credentials.current}, {"servers", json::object()}};
  for (const auto& [address, login] : credentials.servers) {
    root["servers"][address] = {{"user", login.user},
                                {"token", login.token},
                                {"ca", login.ca_file},
                                {"fingerprint", login.fingerprint},
                                {"plaintext", login.plaintext}};
  }
  const std::string draft = path.string() + ".new";
  ::unlink(draft.c_str());
  const int fd = ::open(draft.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR);
  if (fd < 0) return Cannot("write", draft);
  const bool written =
      WriteAll(fd, root.dump(2, ' ', false, json::error_handler_t::replace) + "\n");
  ::close(fd);
  if (!written || ::rename(draft.c_str(), path.c_str()) != 0) return Cannot("write", path);
  return {};
}

}  // namespace vs::cli
