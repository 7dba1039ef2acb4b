#include "server/services/shared_observations.h"

namespace vs {

std::shared_ptr<const SharedObservations::List> SharedObservations::Get() {
  MutexLock lock(mutex_);
  const int64_t now_ns = clock_.MonotonicNs();
  if (last_ == nullptr || now_ns - looked_ns_ >= kMaxAgeNs) {
    last_ = std::make_shared<const List>(look_());
    looked_ns_ = now_ns;
  }
  return last_;
}

void SharedObservations::Renew() {
  MutexLock lock(mutex_);
  last_ = nullptr;
}

}  // namespace vs
