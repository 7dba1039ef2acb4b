#include "engine/camera/device_calls.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

namespace vs {
namespace {

using std::chrono::milliseconds;

struct Device {
  int reads = 0;
};
using Calls = DeviceCalls<Device>;

// A device thread that serves calls until it is told to end.
class Server {
 public:
  explicit Server(Calls& calls) : calls_(calls), thread_([this] { Run(); }) {}
  ~Server() {
    quit_ = true;
    calls_.Poke();
    thread_.join();
  }

 private:
  void Run() {
    Device device;
    while (!quit_) {
      calls_.Run(device, milliseconds(5));
      calls_.Sleep(milliseconds(1000));
    }
  }

  Calls& calls_;
  std::atomic<bool> quit_ = false;
  std::thread thread_;
};

Calls::Step<int> Read() {
  return [](Device& device) -> std::optional<Result<int>> { return ++device.reads; };
}

TEST(DeviceCalls, RunsOnTheDeviceThreadAndGivesTheResult) {
  Calls calls;
  Server server(calls);
  EXPECT_EQ(calls.Call<int>(Read()).value(), 1);
  EXPECT_EQ(calls.Call<int>(Read()).value(), 2);
}

TEST(DeviceCalls, RepeatsAStepUntilItHasAResult) {
  Calls calls;
  Server server(calls);
  const auto result = calls.Call<int>([](Device& device) -> std::optional<Result<int>> {
    if (++device.reads < 100) return std::nullopt;
    return device.reads;
  });
  EXPECT_EQ(result.value(), 100);
}

TEST(DeviceCalls, FailsAtOnceWhileTheDeviceIsRefusing) {
  Calls calls;
  calls.Refuse(Unavailable("unplugged"));
  EXPECT_EQ(calls.Call<int>(Read()).error(), Unavailable("unplugged"));
  calls.AdmitOpen();
  Server server(calls);
  EXPECT_TRUE(calls.Call<int>(Read()).has_value());
}

TEST(DeviceCalls, LetsWaitingCallersGoWhenTheDeviceIsLost) {
  Calls calls;
  std::optional<Result<int>> result;
  std::thread caller([&] { result = calls.Call<int>(Read()); });
  while (!calls.Waiting()) std::this_thread::yield();
  calls.Refuse(Unavailable("unplugged"));
  caller.join();
  EXPECT_EQ(result->error(), Unavailable("unplugged"));
}

TEST(DeviceCalls, DoesNotWaitForeverForADeviceThatHangs) {
  Calls calls;
  calls.AdmitOpen();
  EXPECT_EQ(calls.Call<int>(Read()).error().code(), StatusCode::kUnavailable);
  // The step that nobody waits for any more is not run.
  Device device;
  calls.Run(device, milliseconds(5));
  EXPECT_EQ(device.reads, 0);
}

TEST(DeviceCalls, RefusesAtOnceWhileTheDeviceIsStuckInACall) {
  Calls calls;
  calls.AdmitOpen();
  std::atomic<bool> stuck = false;
  std::atomic<bool> release = false;
  Server server(calls);
  std::thread victim([&] {
    (void)calls.Call<int>([&](Device&) -> std::optional<Result<int>> {
      stuck = true;
      while (!release) std::this_thread::sleep_for(milliseconds(1));
      return 0;
    });
  });
  while (!stuck) std::this_thread::yield();
  // The first caller gives up after a second; by then the device is known to hang.
  victim.join();
  std::vector<Status> answers;
  answers.reserve(1000);
  for (int i = 0; i < 1000; ++i) answers.push_back(calls.Call<int>(Read()).error());
  release = true;
  for (const Status& answer : answers) EXPECT_EQ(answer.code(), StatusCode::kUnavailable);
}

TEST(DeviceCalls, BoundsTheQueue) {
  Calls calls;
  std::vector<std::thread> callers;
  std::atomic<int> exhausted = 0;
  callers.reserve(40);
  for (int i = 0; i < 40; ++i) {
    callers.emplace_back([&] {
      const auto result = calls.Call<int>(Read());
      if (!result && result.error().code() == StatusCode::kResourceExhausted) ++exhausted;
    });
  }
  while (exhausted < 24) std::this_thread::yield();
  calls.Refuse(Unavailable("end"));
  for (std::thread& caller : callers) caller.join();
  EXPECT_EQ(exhausted, 24);
}

}  // namespace
}  // namespace vs
