#pragma once

#include <string>
#include <string_view>

namespace vs {

// What a caller may do; the table is policy.cc. Numbers are stored: never reused.
enum class Role {
  kViewer = 1,
  kOperator = 2,
  kEngineer = 3,
  kAdmin = 4,
  kRobot = 5,  // a machine with an API key
};

// "viewer", "operator" ...
std::string_view RoleName(Role role);

// Who makes a call, as far as the server knows.
struct Caller {
  enum class Kind { kNobody, kUser, kApiKey };

  Kind kind = Kind::kNobody;
  std::string name;           // of the user or the API key
  Role role = Role::kViewer;  // means nothing for kNobody
  std::string credential_id;  // id of the login session or of the API key
  // Logged in with a one-time password: may do nothing but change it.
  bool must_change_password = false;
};

// Engineers and administrators may set every parameter; operators and robots only those that are
// marked for operators.
inline bool MaySetEveryParameter(const Caller& caller) {
  return caller.kind != Caller::Kind::kNobody &&
         (caller.role == Role::kEngineer || caller.role == Role::kAdmin);
}

}  // namespace vs
