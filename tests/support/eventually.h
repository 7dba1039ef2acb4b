#pragma once

#include <chrono>
#include <thread>

#include "tests/support/child_process.h"

namespace vs::test {

// True as soon as `condition` holds; false when it does not within `patience`.
template <class Condition>
bool Eventually(const Condition& condition, std::chrono::milliseconds patience = kPatience) {
  const auto end = std::chrono::steady_clock::now() + patience;
  while (!condition()) {
    if (std::chrono::steady_clock::now() >= end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

}  // namespace vs::test
