#include "server/access/caller.h"

namespace vs {

std::string_view RoleName(Role role) {
  switch (role) {
    case Role::kViewer:
      return "viewer";
    case Role::kOperator:
      return "operator";
    case Role::kEngineer:
      return "engineer";
    case Role::kAdmin:
      return "admin";
    case Role::kRobot:
      return "robot";
  }
  return "unknown";
}

}  // namespace vs
