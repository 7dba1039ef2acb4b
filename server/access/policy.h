#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "engine/base/status.h"
#include "server/access/caller.h"

namespace vs {

// Which roles may call a method.
struct RoleSet {
  uint32_t bits = 0;

  constexpr bool Contains(Role role) const {
    return (bits & (1U << static_cast<unsigned>(role))) != 0;
  }
  constexpr RoleSet operator|(RoleSet other) const { return {bits | other.bits}; }
};

// One line of the table of rights.
struct AccessRule {
  std::string_view method;  // "/visionserver.v1.SessionService/Login"
  RoleSet roles;
  bool without_login = false;           // anybody, no token needed
  bool before_password_change = false;  // also with a one-time password
  bool changes = false;  // something that outlives the call, so that it is recorded: server/audit
};

// The whole table: every method of every service, each once.
std::span<const AccessRule> AccessRules();

// Null when the table has no line for this method: nobody may call it.
const AccessRule* FindAccessRule(std::string_view method);

// UNAUTHENTICATED or PERMISSION_DENIED unless `caller` may call `method`.
Status CheckAccess(std::string_view method, const Caller& caller);

}  // namespace vs
