#include "engine/camera/clock_mapper.h"

#include <algorithm>

namespace vs {
namespace {

constexpr int64_t kDriftPerMillion = 200;

}  // namespace

void ClockMapper::Add(int64_t device_ns, int64_t host_ns) {
  const int64_t sample_ns = host_ns - device_ns;
  if (!known_) {
    known_ = true;
    offset_ns_ = sample_ns;
    last_host_ns_ = host_ns;
    return;
  }
  const int64_t elapsed_ns = std::max<int64_t>(host_ns - last_host_ns_, 0);
  offset_ns_ = std::min(sample_ns, offset_ns_ + elapsed_ns / 1'000'000 * kDriftPerMillion);
  last_host_ns_ += elapsed_ns;
}

}  // namespace vs
