#include "server/streams/credit.h"

namespace vs {

Credit::Credit(size_t window, double max_fps)
    : window_(window), period_ns_(max_fps > 0 ? static_cast<int64_t>(1e9 / max_fps) : 0) {}

std::optional<int64_t> Credit::AllowedFrom() const {
  if (sent_.size() >= window_) return std::nullopt;
  return due_ns_;
}

void Credit::Continue(const Credit& before) {
  sent_ = before.sent_;
  // Nothing was sent yet, or the last item's time and the new period.
  due_ns_ = before.due_ns_ == 0 ? 0 : before.due_ns_ - before.period_ns_ + period_ns_;
}

void Credit::OnSent(uint64_t seq, int64_t now_ns) {
  sent_.push_back({seq, now_ns});
  // Keeps the pace when an item comes a little late, but never makes up for a pause.
  due_ns_ = (now_ns - due_ns_ < period_ns_ ? due_ns_ : now_ns) + period_ns_;
}

void Credit::OnAck(uint64_t seq) {
  if (sent_.empty() || seq > sent_.back().seq) return;
  while (!sent_.empty() && sent_.front().seq <= seq) sent_.pop_front();
}

std::optional<int64_t> Credit::UnacknowledgedSince() const {
  if (sent_.empty()) return std::nullopt;
  return sent_.front().time_ns;
}

}  // namespace vs
