#include "tests/support/gevsim.h"

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

}  // namespace vs::test
