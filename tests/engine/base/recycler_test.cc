#include "engine/base/recycler.h"

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <thread>
#include <vector>

#include "tests/support/count_allocations.h"

namespace vs {
namespace {

struct Picture {
  std::array<int, 32> rows{};
};

TEST(Recycler, GivesTheMemoryOfAFreedObjectToTheNext) {
  const Recycler<Picture> memory;
  const Picture* first = std::allocate_shared<Picture>(memory).get();
  const uint64_t before = test::Allocations();
  const auto second = std::allocate_shared<Picture>(memory);
  EXPECT_EQ(second.get(), first);
  EXPECT_EQ(test::Allocations(), before);
  EXPECT_NE(std::allocate_shared<Picture>(memory).get(), first) << "second still lives";
}

TEST(Recycler, NeverGivesABlockOfAnotherSize) {
  Recycler<int> memory;
  int* small = memory.allocate(1);
  memory.deallocate(small, 1);
  int* large = memory.allocate(100);
  EXPECT_NE(large, small);
  memory.deallocate(large, 100);
  EXPECT_EQ(memory.allocate(1), small);
  memory.deallocate(small, 1);
}

TEST(Recycler, ObjectsOutliveItAndMayEndOnAnotherThread) {
  std::vector<std::shared_ptr<Picture>> pictures;
  {
    const Recycler<Picture> memory;
    for (int i = 0; i < 10; ++i) pictures.push_back(std::allocate_shared<Picture>(memory));
  }
  std::thread reader([shared = std::move(pictures)]() mutable {
    EXPECT_EQ(shared[9]->rows[31], 0);
    shared.clear();
  });
  reader.join();
}

}  // namespace
}  // namespace vs
