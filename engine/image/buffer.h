#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

namespace vs {

// Where the bytes of a Buffer are.
enum class Place : uint8_t {
  kHost,     // ordinary memory
  kPinned,   // host memory that a GPU can copy from directly
  kDevice,   // GPU memory; the CPU must not touch it
  kForeign,  // memory of a driver or another process, readable by the CPU
};

// Ref-counted bytes. Copying a Buffer shares them; they are given back (to a pool, a camera, a
// driver) when the last copy goes. Only the creator writes, and only before the first share.
struct Buffer {
  std::byte* data = nullptr;
  size_t size_bytes = 0;
  Place place = Place::kHost;
  std::shared_ptr<const void> owner;
};

// Makes memory known to a device, which then copies from and to it directly. Thread-safe.
class MemoryPinner {
 public:
  virtual ~MemoryPinner() = default;
  // False if that cannot be done; the memory is then as good as any other.
  virtual bool Pin(std::byte* data, size_t size_bytes) = 0;
  virtual void Unpin(std::byte* data) = 0;
};

// Recycles page-aligned host memory. After the first frames every Acquire is served from memory
// that an earlier frame gave back, without asking the heap. Thread-safe; buffers may outlive the
// pool. The memory is not cleared.
//
// When sizes change, memory of sizes that come no more would pile up: so whenever a slab of a new
// size is made, only the kMaxIdleSlabs that were given back last are kept of the others. That is
// more than any block uses for one frame, so in a warm sequence nothing is made or freed.
class BufferPool {
 public:
  BufferPool() : BufferPool(nullptr) {}
  // A pool of pinned memory, unless `pinner` is null.
  explicit BufferPool(std::shared_ptr<MemoryPinner> pinner);
  ~BufferPool();
  BufferPool(const BufferPool&) = delete;
  BufferPool& operator=(const BufferPool&) = delete;

  Buffer Acquire(size_t size_bytes);

  static constexpr size_t kMaxIdleSlabs = 16;

  // Slabs that this pool ever took from the heap: constant once the sequence is warm.
  uint64_t SlabsMade() const;
  // Of all slabs that it has now, idle and in use.
  size_t BytesHeld() const;

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace vs
