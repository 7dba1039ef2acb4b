#include "server/rpc/executor.h"

#include <gtest/gtest.h>

#include <atomic>
#include <latch>
#include <thread>

#include "server/rpc/timer.h"
#include "tests/support/wait_until.h"

namespace vs {
namespace {

TEST(Executor, RunsEveryTask) {
  std::atomic<int> runs{0};
  {
    Executor executor(3, 1000);
    for (int i = 0; i < 1000; ++i) ASSERT_TRUE(executor.Post([&] { ++runs; }));
  }
  EXPECT_EQ(runs, 1000);
}

TEST(Executor, RefusesWhatDoesNotFitInItsQueue) {
  std::latch started(1);
  std::latch go_on(1);
  std::atomic<int> runs{0};
  Executor executor(1, 2);
  ASSERT_TRUE(executor.Post([&] {
    started.count_down();
    go_on.wait();
  }));
  started.wait();
  EXPECT_TRUE(executor.Post([&] { ++runs; }));
  EXPECT_TRUE(executor.Post([&] { ++runs; }));
  EXPECT_FALSE(executor.Post([&] { ++runs; }));
  go_on.count_down();
  executor.Stop();
  EXPECT_EQ(runs, 2);
}

TEST(Executor, RefusesTasksOnceStopped) {
  Executor executor(1, 10);
  executor.Stop();
  EXPECT_FALSE(executor.Post([] {}));
}

TEST(Timer, CallsInTheOrderOfTheInstants) {
  const int64_t now_ns = SystemClock().MonotonicNs();
  std::vector<int> order;
  std::atomic<bool> done{false};
  Timer timer;
  timer.At(now_ns + 30'000'000, [&] {
    order.push_back(3);
    done = true;
  });
  timer.At(now_ns + 20'000'000, [&] { order.push_back(2); });
  timer.At(now_ns - 1, [&] { order.push_back(1); });
  EXPECT_TRUE(test::WaitUntil([&] { return done.load(); }));
  EXPECT_EQ(order, (std::vector<int>{1, 2, 3}));
}

TEST(Timer, DropsWhatIsNotDueWhenItGoes) {
  bool called = false;
  {
    Timer timer;
    timer.At(SystemClock().MonotonicNs() + 3'600'000'000'000, [&] { called = true; });
  }
  EXPECT_FALSE(called);
}

}  // namespace
}  // namespace vs
