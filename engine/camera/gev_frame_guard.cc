#include "engine/camera/gev_frame_guard.h"

namespace vs {
namespace {

constexpr uint64_t kIdCount = 65535;  // 1..65535

// How far `id` is ahead of `last`; 0 or negative when it is not ahead.
int64_t Ahead(uint64_t id, uint64_t last) {
  if (id > kIdCount || last > kIdCount) return static_cast<int64_t>(id - last);
  const auto distance = static_cast<int64_t>((id + kIdCount - last) % kIdCount);
  return distance > static_cast<int64_t>(kIdCount / 2) ? distance - static_cast<int64_t>(kIdCount)
                                                       : distance;
}

}  // namespace

GevFrameGuard::Verdict GevFrameGuard::Check(uint64_t frame_id, int64_t timestamp_ns) {
  if (frame_id == 0) return {};
  Verdict verdict;
  int64_t ahead = 1;
  if (started_) {
    ahead = Ahead(frame_id, last_id_);
    if (ahead <= 0) return {};
    const bool has_clock = timestamp_ns != 0 && last_timestamp_ns_ != 0;
    if (has_clock && timestamp_ns <= last_timestamp_ns_) {
      verdict.clock_restarted = doubtful_id_ != 0 && Ahead(frame_id, doubtful_id_) > 0 &&
                                timestamp_ns > doubtful_timestamp_ns_;
      doubtful_id_ = frame_id;
      doubtful_timestamp_ns_ = timestamp_ns;
      if (!verdict.clock_restarted) return {};
    }
  }
  started_ = true;
  doubtful_id_ = 0;
  last_id_ = frame_id;
  last_timestamp_ns_ = timestamp_ns;
  last_number_ += static_cast<uint64_t>(ahead);
  verdict.fresh = true;
  verdict.number = last_number_;
  verdict.lost = static_cast<uint64_t>(ahead - 1);
  return verdict;
}

}  // namespace vs
