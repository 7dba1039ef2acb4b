#include "server/streams/encoder_pool.h"

#include <utility>

namespace vs {
namespace {

// One for each stream and encoding that somebody waits for, so it never fills in earnest.
constexpr size_t kMaxQueued = 4096;

}  // namespace

EncoderPool::EncoderPool(int threads, const Clock& clock)
    : clock_(clock), threads_(threads, kMaxQueued) {}

bool EncoderPool::Post(std::function<void(FrameEncoder&)> task) {
  return threads_.Post([this, task = std::move(task)] { RunHere(task); });
}

void EncoderPool::RunHere(const std::function<void(FrameEncoder&)>& task) {
  std::unique_ptr<FrameEncoder> encoder;
  {
    MutexLock lock(mutex_);
    if (!idle_.empty()) {
      encoder = std::move(idle_.back());
      idle_.pop_back();
    }
  }
  if (encoder == nullptr) encoder = std::make_unique<FrameEncoder>(clock_);
  task(*encoder);
  MutexLock lock(mutex_);
  idle_.push_back(std::move(encoder));
}

}  // namespace vs
