#pragma once

#include <chrono>
#include <thread>

namespace vs::test {

// Polls `condition` until it holds. False after a minute: then something is stuck, however loaded
// the machine.
template <class Condition>
bool WaitUntil(const Condition& condition) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
  return true;
}

}  // namespace vs::test
