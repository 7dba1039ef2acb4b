#include "engine/image/buffer.h"

#include <gtest/gtest.h>

#include <memory>
#include <set>
#include <thread>
#include <vector>

#include "engine/image/image.h"

namespace vs {
namespace {

TEST(BufferPool, GivesTheSameMemoryAgainOnceTheLastReaderLetGo) {
  BufferPool pool;
  Buffer first = pool.Acquire(1000);
  const std::byte* memory = first.data;
  Buffer shared = first;
  first = {};
  EXPECT_NE(pool.Acquire(1000).data, memory) << "still read by `shared`";
  shared = {};
  const Buffer a = pool.Acquire(1000);
  const Buffer b = pool.Acquire(1000);
  EXPECT_TRUE(a.data == memory || b.data == memory);
  EXPECT_EQ(pool.SlabsMade(), 2u);
}

// Pins only memory of up to 8192 bytes.
class FakePinner final : public MemoryPinner {
 public:
  bool Pin(std::byte* data, size_t size_bytes) override {
    return size_bytes <= 8192 && pinned.insert(data).second;
  }
  void Unpin(std::byte* data) override { EXPECT_EQ(pinned.erase(data), 1U); }

  std::set<std::byte*> pinned;
};

TEST(BufferPool, PinsItsMemoryAsLongAsItHasIt) {
  const auto pinner = std::make_shared<FakePinner>();
  {
    BufferPool pool(pinner);
    const Buffer small = pool.Acquire(5000);
    EXPECT_EQ(small.place, Place::kPinned);
    EXPECT_EQ(pinner->pinned, std::set<std::byte*>{small.data});
    EXPECT_EQ(pool.Acquire(9000).place, Place::kHost) << "could not be pinned";
    for (size_t k = 0; k < 3; ++k) EXPECT_EQ(pool.Acquire(100).place, Place::kPinned);
    EXPECT_EQ(pinner->pinned.size(), 2U);
  }
  EXPECT_TRUE(pinner->pinned.empty());
}

constexpr size_t kPageBytes = 4096;

TEST(BufferPool, KeepsLittleOfSizesThatComeNoMore) {
  BufferPool pool;
  for (size_t pages = 1; pages <= 100; ++pages) (void)pool.Acquire(pages * kPageBytes);
  EXPECT_EQ(pool.SlabsMade(), 100u);
  // 84 .. 100 pages: the new slab and the 16 before it.
  EXPECT_EQ(pool.BytesHeld(), size_t{17} * 92 * kPageBytes);
}

TEST(BufferPool, MakesNothingNewWhileTheSameFewSizesComeAgain) {
  BufferPool pool;
  for (int frame = 0; frame < 10; ++frame) {
    for (size_t pages = 1; pages <= BufferPool::kMaxIdleSlabs; ++pages) {
      (void)pool.Acquire(pages * kPageBytes);
    }
  }
  EXPECT_EQ(pool.SlabsMade(), BufferPool::kMaxIdleSlabs);
}

TEST(BufferPool, NeverFreesWhatIsInUse) {
  BufferPool pool;
  std::vector<Buffer> in_use;
  for (size_t pages = 1; pages <= 40; ++pages) {
    in_use.push_back(pool.Acquire(pages * kPageBytes));
    in_use.back().data[0] = std::byte{static_cast<uint8_t>(pages)};
  }
  (void)pool.Acquire(100 * kPageBytes);
  EXPECT_EQ(pool.BytesHeld(), (820 + 100) * kPageBytes);  // 1 + 2 + ... + 40 = 820
  for (size_t i = 0; i < in_use.size(); ++i) {
    EXPECT_EQ(in_use[i].data[0], std::byte{static_cast<uint8_t>(i + 1)});
  }
}

TEST(BufferPool, BuffersOutliveThePool) {
  Buffer buffer;
  {
    BufferPool pool;
    buffer = pool.Acquire(100);
  }
  buffer.data[99] = std::byte{7};
  EXPECT_EQ(buffer.data[99], std::byte{7});
}

TEST(BufferPool, ServesManyThreads) {
  BufferPool pool;
  std::vector<std::thread> threads;
  threads.reserve(4);
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&pool, t] {
      for (int i = 0; i < 500; ++i) {
        Image<uint8_t> image(pool, 64, 48);
        image.Fill(static_cast<uint8_t>(t));
        ASSERT_EQ(image.Row(47)[63], t);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_LE(pool.SlabsMade(), 4u);
}

TEST(Image, RefusesAViewThatReachesBeyondItsBuffer) {
  BufferPool pool;
  EXPECT_THROW(Image<uint16_t>(pool.Acquire(100), 10, 6, 20), BrokenInvariant);
  EXPECT_THROW(Image<uint16_t>(pool.Acquire(100), 10, 5, 19), BrokenInvariant);
}

}  // namespace
}  // namespace vs
