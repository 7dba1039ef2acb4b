#include "engine/image/buffer.h"

#include <gtest/gtest.h>

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
