#include "tests/support/network_namespace.h"

#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <vector>

#include "engine/base/str.h"
#include "tests/support/child_process.h"

namespace vs::test {
namespace {

constexpr char kInside[] = "VS_TEST_OWN_NETWORK";

std::optional<std::string> SetLoopbackUp() {
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  ifreq request{};
  std::strcpy(request.ifr_name, "lo");
  bool up = fd >= 0 && ioctl(fd, SIOCGIFFLAGS, &request) == 0;
  request.ifr_flags |= IFF_UP;
  up = up && ioctl(fd, SIOCSIFFLAGS, &request) == 0;
  const int reason = errno;
  if (fd >= 0) close(fd);
  if (up) return std::nullopt;
  return Str("cannot set the loopback interface up: ", std::strerror(reason));
}

}  // namespace

std::optional<std::string> EnterOwnNetwork(int argument_count, char** arguments) {
  if (std::getenv(kInside) != nullptr) return SetLoopbackUp();

  std::vector<std::string> command = {"unshare", geteuid() == 0 ? "-n" : "-Urn", "--"};
  std::vector<std::string> probe = command;
  probe.emplace_back("true");
  const Result<FinishedProcess> probed = RunProcess(probe);
  if (!probed) return probed.error().message();
  if (probed->exit_code != 0) return probed->error_output;

  setenv(kInside, "1", 1);
  command.push_back(std::filesystem::read_symlink("/proc/self/exe"));
  command.insert(command.end(), arguments + 1, arguments + argument_count);
  std::vector<char*> pointers(command.size() + 1, nullptr);
  for (size_t i = 0; i < command.size(); ++i) pointers[i] = command[i].data();
  execvp(pointers[0], pointers.data());
  return Str("cannot run unshare: ", std::strerror(errno));
}

}  // namespace vs::test
