#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>

namespace vs {

// Memory for a matcher's volumes. It only grows, so that a warm matcher asks for none; it begins at
// a multiple of 64 bytes and is not cleared.
class CellMemory {
 public:
  // Null when there is not enough.
  uint8_t* Reserve(size_t bytes) {
    if (bytes <= capacity_) return memory_.get();
    memory_.reset();
    // Volumes of many megabytes in huge pages: a sweep touches a new page every few pixels.
    const size_t alignment = bytes < kHugePage ? 64 : kHugePage;
    capacity_ = (bytes + alignment - 1) / alignment * alignment;
    memory_.reset(static_cast<uint8_t*>(std::aligned_alloc(alignment, capacity_)));
    if (memory_ == nullptr) {
      capacity_ = 0;
    } else if (alignment == kHugePage) {
      madvise(memory_.get(), capacity_, MADV_HUGEPAGE);  // as good without
    }
    return memory_.get();
  }
  size_t Bytes() const { return capacity_; }

 private:
  static constexpr size_t kHugePage = size_t{2} << 20;
  struct Free {
    void operator()(uint8_t* memory) const { std::free(memory); }
  };
  std::unique_ptr<uint8_t, Free> memory_;
  size_t capacity_ = 0;
};

}  // namespace vs
