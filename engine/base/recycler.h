#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <utility>
#include <vector>

#include "engine/base/mutex.h"

namespace vs {

namespace internal {

// Freed blocks of any size, kept for the next request of that size. Thread-safe.
class BlockStore {
 public:
  ~BlockStore() {
    for (const Block& block : free_) ::operator delete(block.memory);
  }

  void* Take(size_t bytes) VS_EXCLUDES(mutex_) {
    MutexLock lock(mutex_);
    for (size_t i = free_.size(); i-- > 0;) {
      if (free_[i].bytes != bytes) continue;
      void* memory = free_[i].memory;
      free_[i] = free_.back();
      free_.pop_back();
      return memory;
    }
    return ::operator new(bytes);
  }

  void Give(void* memory, size_t bytes) VS_EXCLUDES(mutex_) {
    MutexLock lock(mutex_);
    free_.push_back({memory, bytes});
  }

 private:
  struct Block {
    void* memory;
    size_t bytes;
  };
  Mutex mutex_;
  std::vector<Block> free_ VS_GUARDED_BY(mutex_);
};

}  // namespace internal

// Keeps freed memory blocks of one size for the next allocation, so that a warm sequence asks the
// heap for nothing. A standard allocator: pass it to std::allocate_shared. Copies share the store;
// blocks may be freed on any thread, and after the Recycler itself is gone.
template <class T>
class Recycler {
 public:
  using value_type = T;

  Recycler() : store_(std::make_shared<internal::BlockStore>()) {}
  template <class U>
  // NOLINTNEXTLINE(google-explicit-constructor): allocators convert
  Recycler(const Recycler<U>& other) : store_(other.store_) {}

  T* allocate(size_t count) { return static_cast<T*>(store_->Take(count * sizeof(T))); }
  void deallocate(T* block, size_t count) { store_->Give(block, count * sizeof(T)); }

  template <class U>
  bool operator==(const Recycler<U>& other) const {
    return store_ == other.store_;
  }

 private:
  template <class U>
  friend class Recycler;

  std::shared_ptr<internal::BlockStore> store_;
};

}  // namespace vs
