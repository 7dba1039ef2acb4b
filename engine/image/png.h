#pragma once

#include <cstdint>
#include <vector>

#include "engine/base/status.h"
#include "engine/image/image.h"

namespace vs {

// The picture as a PNG file, packed for speed. Errors: INVALID_ARGUMENT for an empty picture,
// RESOURCE_EXHAUSTED without memory.
Result<std::vector<uint8_t>> EncodePng(const GreyImage& image);
Result<std::vector<uint8_t>> EncodePng(const Image<uint16_t>& image);
Result<std::vector<uint8_t>> EncodePng(const ColorImage& image);

}  // namespace vs
