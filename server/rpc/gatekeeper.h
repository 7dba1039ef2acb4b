#pragma once

#include <string>
#include <string_view>

#include "engine/base/status.h"
#include "server/access/caller.h"

namespace vs {

// Decides who may make which call. Thread-safe, and quick: it is asked on the network's thread.
class Gatekeeper {
 public:
  virtual ~Gatekeeper() = default;

  // Who makes this call. UNAUTHENTICATED when `credential` (what follows "Bearer ", empty when
  // there is none) is not valid, PERMISSION_DENIED when it is but does not reach for `method`.
  virtual Result<Caller> Admit(const std::string& method, std::string_view credential) = 0;
  // Whose this credential is; nobody's when it is not valid.
  virtual Caller Identify(std::string_view credential) = 0;
  // Asked several times a second for every open stream: may it go on? `in_use`: the client has read
  // something since the last time, which counts as activity of its session.
  virtual Status Recheck(const std::string& method, const Caller& caller, bool in_use) = 0;
};

}  // namespace vs
