#include "engine/sim/gevsim/control_privilege.h"

#include "engine/sim/gevsim/register_addresses.h"

namespace vs::sim {

GevStatus ControlPrivilege::Request(const Endpoint& client, uint32_t wanted, int64_t now_ns) {
  if (holder_ && !Holds(client)) return GevStatus::kAccessDenied;
  if ((wanted & (kPrivilegeControl | kPrivilegeExclusive)) == 0) {
    holder_.reset();
    exclusive_ = false;
    return GevStatus::kSuccess;
  }
  holder_ = client;
  exclusive_ = (wanted & kPrivilegeExclusive) != 0;
  heard_ns_ = now_ns;
  return GevStatus::kSuccess;
}

void ControlPrivilege::Heard(const Endpoint& client, int64_t now_ns) {
  if (Holds(client)) heard_ns_ = now_ns;
}

bool ControlPrivilege::ExpireSilent(int64_t now_ns, int64_t timeout_ns) {
  if (!holder_ || now_ns - heard_ns_ <= timeout_ns) return false;
  holder_.reset();
  exclusive_ = false;
  return true;
}

uint32_t ControlPrivilege::RegisterValue() const {
  if (!holder_) return 0;
  return exclusive_ ? kPrivilegeExclusive : kPrivilegeControl;
}

}  // namespace vs::sim
