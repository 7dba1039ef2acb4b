#pragma once

#include <cstdint>

namespace vs::test {

// How often this program has asked the heap for memory by operator new, on any thread. A test that
// calls it adds count_allocations.cc to its SOURCES, which replaces operator new.
uint64_t Allocations();

}  // namespace vs::test
