#pragma once

#include <string>

#include "engine/base/status.h"
#include "server/rpc/call.h"

namespace vs {

// Hears of the calls that somebody wants to be able to account for. Thread-safe, and quick: it is
// told on the network's thread.
class Auditor {
 public:
  virtual ~Auditor() = default;

  // Whether calls of this method are recorded.
  virtual bool Records(const std::string& method) const = 0;
  // Once for each such call, also one that was refused, when its outcome is known. `call.subject`
  // says what it was about, as far as its request was read.
  virtual void Record(const Call& call, const Status& outcome) = 0;
};

}  // namespace vs
