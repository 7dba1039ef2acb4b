#include "engine/camera/player.h"

#include <utility>

namespace vs {

using std::chrono::duration;
using std::chrono::duration_cast;
using std::chrono::steady_clock;

void Player::Start(size_t count, const PlayOptions& options, Show show) {
  Stop();
  {
    MutexLock lock(mutex_);
    stop_ = false;
  }
  playing_ = true;
  thread_ = std::thread([this, count, options, show = std::move(show)] {
    Run(count, options, show);
    playing_ = false;
  });
}

void Player::Stop() {
  {
    MutexLock lock(mutex_);
    stop_ = true;
    stopped_.NotifyAll();
  }
  if (thread_.joinable()) thread_.join();
}

void Player::Run(size_t count, const PlayOptions& options, const Show& show) {
  const auto begin = steady_clock::now();
  uint64_t number = 0;
  do {
    for (size_t index = 0; index < count; ++index) {
      const duration<double> since_begin(options.fps > 0 ? static_cast<double>(number) / options.fps
                                                         : 0);
      if (!WaitUntil(begin + duration_cast<steady_clock::duration>(since_begin))) return;
      if (!show(index, ++number)) return;
    }
  } while (options.loop);
}

bool Player::WaitUntil(steady_clock::time_point due) {
  MutexLock lock(mutex_);
  while (!stop_) {
    const auto left = due - steady_clock::now();
    if (left.count() <= 0) return true;
    stopped_.WaitFor(mutex_, left);
  }
  return false;
}

}  // namespace vs
