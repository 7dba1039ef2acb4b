#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "engine/core/value.h"

namespace vs::test {

// Made-up values that a port of this type may get: pictures of several sizes down to one pixel, raw
// and rectified, maps with and without valid pixels. None for a type that is unknown here.
std::vector<Value> SyntheticValues(std::string_view port_type);

// Over all that a reader of the value can see, pixels included.
uint64_t HashOf(const Value& value);

}  // namespace vs::test
