#include "engine/base/listeners.h"

#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <thread>

namespace vs {
namespace {

TEST(Listeners, AreCalledUntilTheirHandleGoes) {
  Listeners<int> listeners;
  int first = 0;
  int second = 0;
  auto handle = listeners.Add([&first](int value) { first += value; });
  const auto other = listeners.Add([&second](int value) { second += value; });
  listeners.Call(1);
  handle.reset();
  listeners.Call(10);
  EXPECT_EQ(first, 1);
  EXPECT_EQ(second, 11);
}

TEST(Listeners, DroppingTheHandleWaitsForACallThatIsUnderWay) {
  Listeners<> listeners;
  std::promise<void> called;
  std::promise<void> go_on;
  std::atomic<bool> returned = false;
  std::atomic<bool> dropped = false;
  auto handle = listeners.Add([&] {
    called.set_value();
    go_on.get_future().wait();
    for (int i = 0; i < 1000 && !dropped; ++i) std::this_thread::yield();
    EXPECT_FALSE(dropped);
    returned = true;
  });
  std::thread caller([&] { listeners.Call(); });
  called.get_future().wait();
  std::thread dropper([&] {
    handle.reset();
    dropped = true;
    EXPECT_TRUE(returned);
  });
  go_on.set_value();
  caller.join();
  dropper.join();
}

TEST(Listeners, OneMayAddAnotherWhileItIsCalled) {
  Listeners<> listeners;
  int calls = 0;
  std::shared_ptr<void> added;
  const auto handle = listeners.Add([&] {
    if (added == nullptr) added = listeners.Add([&calls] { ++calls; });
  });
  listeners.Call();
  listeners.Call();
  EXPECT_EQ(calls, 1);
}

TEST(Listeners, HandlesOutliveThem) {
  std::shared_ptr<void> handle;
  {
    Listeners<> listeners;
    handle = listeners.Add([] {});
  }
  handle.reset();
}

}  // namespace
}  // namespace vs
