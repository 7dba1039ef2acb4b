#include "gpu/device_board.h"

#include <algorithm>
#include <iterator>
#include <tuple>
#include <utility>

#include "engine/base/str.h"

namespace vs::gpu {

DeviceBoard::Seat::Seat(Seat&& other) noexcept
    : board_(std::exchange(other.board_, nullptr)),
      device_(other.device_),
      failing_(other.failing_) {}

DeviceBoard::Seat::~Seat() {
  if (board_ == nullptr) return;
  Works();
  MutexLock lock(board_->mutex_);
  --board_->entries_[static_cast<size_t>(device_)].seats;
}

void DeviceBoard::Seat::Fails(const Status& why) {
  MutexLock lock(board_->mutex_);
  Entry& entry = board_->entries_[static_cast<size_t>(device_)];
  if (!failing_) ++entry.failing;
  failing_ = true;
  entry.why = why;
}

void DeviceBoard::Seat::Works() {
  if (!failing_) return;
  MutexLock lock(board_->mutex_);
  --board_->entries_[static_cast<size_t>(device_)].failing;
  failing_ = false;
}

int DeviceBoard::BestOf(const std::vector<Entry>& entries, const std::vector<int>& without) {
  // Of two keys the lesser is the better.
  const auto key = [&](int k) {
    const Entry& entry = entries[static_cast<size_t>(k)];
    const bool passed_over = std::find(without.begin(), without.end(), k) != without.end();
    return std::tuple(passed_over, entry.failing > 0, entry.seats);
  };
  int best = 0;
  for (int k = 1; k < static_cast<int>(entries.size()); ++k) {
    if (key(k) < key(best)) best = k;
  }
  return best;
}

Result<DeviceBoard::Seat> DeviceBoard::Take(int device, const std::vector<int>& without) {
  MutexLock lock(mutex_);
  const auto count = static_cast<int>(entries_.size());
  if (device >= count || (device == kAny && std::ssize(without) >= count)) {
    return NotFound(Str("there is no GPU ", std::max(device, 0), "; this machine has ", count,
                        count > 0 ? Str(", from 0 to ", count - 1) : ""));
  }
  if (device == kAny) device = BestOf(entries_, without);
  ++entries_[static_cast<size_t>(device)].seats;
  return Seat(this, device);
}

std::vector<DeviceBoard::Fault> DeviceBoard::Faults() const {
  std::vector<Fault> faults;
  MutexLock lock(mutex_);
  for (size_t k = 0; k < entries_.size(); ++k) {
    const Entry& entry = entries_[k];
    if (entry.failing == 0) continue;
    faults.push_back({.device = static_cast<int>(k), .matchers = entry.failing, .why = entry.why});
  }
  return faults;
}

}  // namespace vs::gpu
