#include "engine/base/clock.h"

#include <ctime>

namespace vs {
namespace {

int64_t Now(clockid_t id) {
  timespec now{};
  clock_gettime(id, &now);
  return int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

}  // namespace

int64_t SystemClock::MonotonicNs() const { return Now(CLOCK_MONOTONIC); }
int64_t SystemClock::UtcNs() const { return Now(CLOCK_REALTIME); }

}  // namespace vs
