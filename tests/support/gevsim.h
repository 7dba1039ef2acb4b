#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/base/status.h"
#include "tests/support/child_process.h"

namespace vs::test {

// The program gevsim, ready to be connected to: cameras 21000001 (left) at 127.0.0.1 and 21000002
// (right) at 127.0.0.2 unless the options say otherwise. Only for tests with a network of their
// own (tests_support_own_network). Ends with the object.
Result<std::unique_ptr<ChildProcess>> StartGevSim(const std::vector<std::string>& options = {});

// Sends a command to a gevsim that was started with `--control socket_path` and gives its answer:
// "left drop 0.01", "unplug", "trigger", "stats" ... (engine/sim/gevsim/rig.h).
Result<std::string> AskGevSim(const std::string& socket_path, const std::string& command);

}  // namespace vs::test
