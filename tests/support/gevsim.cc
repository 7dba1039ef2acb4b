#include "tests/support/gevsim.h"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "engine/base/str.h"

namespace vs::test {

Result<std::unique_ptr<ChildProcess>> StartGevSim(const std::vector<std::string>& options) {
  std::vector<std::string> command = {VS_GEVSIM};
  command.insert(command.end(), options.begin(), options.end());
  VS_ASSIGN_OR_RETURN(std::unique_ptr<ChildProcess> gevsim, ChildProcess::Start(command));
  if (!gevsim->WaitForLine("gevsim ready")) {
    return Unavailable(Str("gevsim did not get ready: ", gevsim->ErrorOutput()));
  }
  return gevsim;
}

Result<std::string> AskGevSim(const std::string& socket_path, const std::string& command) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  socket_path.copy(address.sun_path, sizeof address.sun_path - 1);
  const int fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const std::string line = command + "\n";
  std::string answer;
  if (connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 &&
      send(fd, line.data(), line.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(line.size())) {
    for (char c = 0; recv(fd, &c, 1, 0) == 1 && c != '\n';) answer += c;
  } else {
    answer = Str("error: cannot talk to ", socket_path, ": ", std::strerror(errno));
  }
  close(fd);
  if (answer.starts_with("error: ")) return InvalidArgument(answer);
  return answer;
}

}  // namespace vs::test
