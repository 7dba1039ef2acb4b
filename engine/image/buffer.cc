#include "engine/image/buffer.h"

#include <cstdlib>
#include <new>
#include <utility>
#include <vector>

#include "engine/base/mutex.h"
#include "engine/base/recycler.h"

namespace vs {
namespace {

constexpr size_t kPageBytes = 4096;

struct Slab {
  std::byte* data;
  size_t size_bytes;
  bool pinned;
};

}  // namespace

struct BufferPool::State {
  explicit State(std::shared_ptr<MemoryPinner> how) : pinner(std::move(how)) {}
  ~State() {
    for (const Slab& slab : free) Free(slab);
  }

  Slab Take(size_t size_bytes) {
    MutexLock lock(mutex);
    for (size_t i = free.size(); i-- > 0;) {
      if (free[i].size_bytes != size_bytes) continue;
      const Slab slab = free[i];
      free.erase(free.begin() + static_cast<std::ptrdiff_t>(i));
      return slab;
    }
    DropOldest();
    auto* data = static_cast<std::byte*>(std::aligned_alloc(kPageBytes, size_bytes));
    if (data == nullptr) throw std::bad_alloc();
    ++slabs_made;
    bytes_held += size_bytes;
    return {data, size_bytes, pinner != nullptr && pinner->Pin(data, size_bytes)};
  }

  void Give(Slab slab) {
    MutexLock lock(mutex);
    free.push_back(slab);
  }

  void DropOldest() VS_REQUIRES(mutex) {
    while (free.size() > kMaxIdleSlabs) {
      bytes_held -= free.front().size_bytes;
      Free(free.front());
      free.erase(free.begin());
    }
  }

  void Free(const Slab& slab) {
    if (slab.pinned) pinner->Unpin(slab.data);
    std::free(slab.data);
  }

  const std::shared_ptr<MemoryPinner> pinner;

  Mutex mutex;
  std::vector<Slab> free VS_GUARDED_BY(mutex);  // given back last at the end
  uint64_t slabs_made VS_GUARDED_BY(mutex) = 0;
  size_t bytes_held VS_GUARDED_BY(mutex) = 0;
  Recycler<std::byte> control_blocks;
};

BufferPool::BufferPool(std::shared_ptr<MemoryPinner> pinner)
    : state_(std::make_shared<State>(std::move(pinner))) {}
BufferPool::~BufferPool() = default;

Buffer BufferPool::Acquire(size_t size_bytes) {
  const size_t rounded = (size_bytes + kPageBytes - 1) / kPageBytes * kPageBytes;
  const Slab slab = state_->Take(rounded == 0 ? kPageBytes : rounded);
  std::shared_ptr<const void> owner(
      slab.data, [state = state_, slab](const void*) { state->Give(slab); },
      state_->control_blocks);
  return {slab.data, size_bytes, slab.pinned ? Place::kPinned : Place::kHost, std::move(owner)};
}

uint64_t BufferPool::SlabsMade() const {
  MutexLock lock(state_->mutex);
  return state_->slabs_made;
}

size_t BufferPool::BytesHeld() const {
  MutexLock lock(state_->mutex);
  return state_->bytes_held;
}

}  // namespace vs
