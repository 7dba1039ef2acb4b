#include "server/access/login_throttle.h"

#include <algorithm>
#include <cmath>

#include "engine/base/str.h"

namespace vs {
namespace {

constexpr int64_t kSecondNs = 1'000'000'000;
constexpr int kFreeFailures = 5;
constexpr int64_t kLongestWaitS = 900;
constexpr int64_t kForgetNs = 3600 * kSecondNs;
constexpr double kAddressFailures = 20;
constexpr double kAddressFailuresPerNs = kAddressFailures / (60.0 * kSecondNs);
// An attacker who invents names must not fill the memory.
constexpr size_t kMaxEntries = 4096;

Status Wait(double seconds) {
  return ResourceExhausted(Str("too many failed logins; try again in ",
                               static_cast<int64_t>(std::ceil(seconds)), " s"))
      .WithReason("TOO_MANY_FAILED_LOGINS");
}

template <class Entry>
void MakeRoom(std::map<std::string, Entry>& entries, int64_t now_ns) {
  if (entries.size() < kMaxEntries) return;
  std::erase_if(entries,
                [&](const auto& entry) { return now_ns - entry.second.last_ns > kForgetNs; });
  if (entries.size() < kMaxEntries) return;
  entries.erase(std::min_element(entries.begin(), entries.end(), [](const auto& a, const auto& b) {
    return a.second.last_ns < b.second.last_ns;
  }));
}

}  // namespace

double LoginThrottle::FailuresNow(const Address& address) const {
  const auto elapsed_ns = static_cast<double>(clock_.MonotonicNs() - address.last_ns);
  return std::max(0.0, address.failures - elapsed_ns * kAddressFailuresPerNs);
}

Status LoginThrottle::CheckAddress(const std::string& address) const {
  MutexLock lock(mutex_);
  const auto found = addresses_.find(address);
  if (found == addresses_.end()) return Status();
  const double surplus = FailuresNow(found->second) - (kAddressFailures - 1);
  if (surplus <= 0) return Status();
  return Wait(surplus / kAddressFailuresPerNs / kSecondNs);
}

Status LoginThrottle::CheckAccount(const std::string& name) const {
  const int64_t wait_ns = LockedForNs(name);
  return wait_ns == 0 ? Status() : Wait(static_cast<double>(wait_ns) / kSecondNs);
}

int64_t LoginThrottle::LockedForNs(const std::string& name) const {
  MutexLock lock(mutex_);
  const auto found = accounts_.find(name);
  if (found == accounts_.end()) return 0;
  return std::max(int64_t{0}, found->second.blocked_until_ns - clock_.MonotonicNs());
}

int64_t LoginThrottle::LockedUntilUtcNs(const std::string& name) const {
  const int64_t wait_ns = LockedForNs(name);
  return wait_ns == 0 ? 0 : clock_.UtcNs() + wait_ns;
}

void LoginThrottle::Failed(const std::string& name, const std::string& address) {
  MutexLock lock(mutex_);
  const int64_t now_ns = clock_.MonotonicNs();

  MakeRoom(accounts_, now_ns);
  Account& account = accounts_[name];
  if (now_ns - account.last_ns > kForgetNs) account.failures = 0;
  account.last_ns = now_ns;
  ++account.failures;
  if (account.failures >= kFreeFailures) {
    const int doublings = std::min(account.failures - kFreeFailures, 10);
    account.blocked_until_ns =
        now_ns + std::min(int64_t{1} << doublings, kLongestWaitS) * kSecondNs;
  }

  MakeRoom(addresses_, now_ns);
  Address& source = addresses_[address];
  source.failures = FailuresNow(source) + 1;
  source.last_ns = now_ns;
}

void LoginThrottle::Forget(const std::string& name) {
  MutexLock lock(mutex_);
  accounts_.erase(name);
}

}  // namespace vs
