#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

#include "engine/base/clock.h"
#include "engine/base/mutex.h"
#include "engine/base/status.h"

namespace vs {

// Slows down guessing of passwords: for an account, failures beyond the fifth double the wait from
// one second to a quarter of an hour; an address has 20 failures a minute. It forgets after an hour
// without failures. Names need not exist, so it does not tell which ones do. Thread-safe.
class LoginThrottle {
 public:
  explicit LoginThrottle(const Clock& clock) : clock_(clock) {}

  // RESOURCE_EXHAUSTED with the seconds to wait.
  Status CheckAddress(const std::string& address) const;
  Status CheckAccount(const std::string& name) const;

  void Failed(const std::string& name, const std::string& address);

  // Forgets the failures of an account: after a login, or because an administrator says so.
  void Forget(const std::string& name);
  // Until when the account takes no password, in UTC; 0 when it does take one.
  int64_t LockedUntilUtcNs(const std::string& name) const;

 private:
  struct Account {
    int failures = 0;
    int64_t last_ns = 0;
    int64_t blocked_until_ns = 0;
  };
  struct Address {
    double failures = 0;  // drains by 20 a minute
    int64_t last_ns = 0;
  };
  double FailuresNow(const Address& address) const;
  int64_t LockedForNs(const std::string& name) const VS_EXCLUDES(mutex_);

  const Clock& clock_;
  mutable Mutex mutex_;
  std::map<std::string, Account> accounts_ VS_GUARDED_BY(mutex_);
  std::map<std::string, Address> addresses_ VS_GUARDED_BY(mutex_);
};

}  // namespace vs
