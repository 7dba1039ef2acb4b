#pragma once

#include <cstdint>

namespace vs {

// Converts times of a camera's clock to the host's monotonic clock.
//
// Each message shows the host clock some delay after the camera stamped it; the smallest difference
// ever seen is the best estimate of the offset (a sliding minimum). As the two crystals drift apart
// by up to 200 ppm, the minimum is let rise at that rate, so that an old sample loses its weight
// bit by bit. The result is late by the smallest delay, never by a queue's.
class ClockMapper {
 public:
  // The host's clock showed `host_ns` shortly after the camera's clock showed `device_ns`.
  void Add(int64_t device_ns, int64_t host_ns);
  // Forgets everything: the camera's clock was reset.
  void Reset() { known_ = false; }

  bool known() const { return known_; }
  // 0 before the first sample.
  int64_t HostNs(int64_t device_ns) const { return known_ ? device_ns + offset_ns_ : 0; }

 private:
  bool known_ = false;
  int64_t offset_ns_ = 0;  // host minus device
  int64_t last_host_ns_ = 0;
};

}  // namespace vs
