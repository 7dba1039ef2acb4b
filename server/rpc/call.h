#pragma once

#include <cstdint>
#include <stop_token>
#include <string>

#include "server/access/caller.h"

namespace vs {

// What a handler knows about a call besides its request. Whether the caller may make this call was
// decided before the handler runs; it looks at `caller` only where the rights depend on the data.
struct Call {
  std::string method;   // "/visionserver.v1.SessionService/Login"
  Caller caller;        // nobody on the few methods that need no login
  std::string address;  // of the client, without the port
  // What the call is about, of a call that is recorded: see SubjectOf.
  std::string subject{};
  // When the request was there, by the host's monotonic clock: a limit of time counts from then.
  int64_t arrived_ns = 0;
  // Stops when the client has gone or the deadline has passed: nobody waits for the answer.
  std::stop_token cancelled;
};

}  // namespace vs
