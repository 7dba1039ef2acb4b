#pragma once

#include <optional>
#include <string>

namespace vs::test {

// Moves this program into a network of its own, where there is only a loopback interface and every
// port is free, by starting it again under `unshare`. GigE Vision needs that: its control port is
// fixed, so two tests on one network would meet. Works for root and, by a user namespace, for
// others.
//
// A test program gets it by linking `tests_support_own_network` (which brings a main function).
//
// Call first thing in main, with main's arguments. Comes back in the new network; or with the
// reason, when the system allows no namespaces.
std::optional<std::string> EnterOwnNetwork(int argument_count, char** arguments);

}  // namespace vs::test
