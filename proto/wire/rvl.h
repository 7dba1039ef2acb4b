#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "proto/wire/decode_error.h"

namespace vs::wire {

// RVL: lossless packing of a disparity, depth or reason image whose invalid pixels are 0.
//
// The image, read row by row as one line, is a series of (run of zeroes, run of non-zeroes). Packed
// are the length of the one, the length of the other, and each value of the latter as its zigzag
// difference from the latest non-zero value before it (0 at the start). Each of these numbers is
// written in nibbles of 3 bits, low bits first, the fourth bit saying that more follow; eight
// nibbles, the first one highest, make a 32-bit word, stored little-endian. The last word is filled
// with zeroes. Source: A. D. Wilson, "Fast Lossless Depth Image Compression", ISS 2017.
//
// At most 2^32 - 1 pixels. O(pixels); no memory is allocated. Safe to call from any thread.

// Room that EncodeRvl needs, in bytes: about 3 for each pixel.
size_t RvlBound(size_t pixels);

// Packs width x height pixels whose rows begin stride_bytes apart, and returns the packed size in
// bytes. `packed` must have room for RvlBound(width * height); with less nothing is written and
// 0 is returned, as it is for an image without pixels.
size_t EncodeRvl(const uint16_t* pixels, size_t width, size_t height, size_t stride_bytes,
                 std::span<uint8_t> packed);
size_t EncodeRvl(const uint8_t* pixels, size_t width, size_t height, size_t stride_bytes,
                 std::span<uint8_t> packed);

// Unpacks exactly pixels.size() pixels. `packed` may be anything, of any alignment: what is not the
// packed form of such an image is answered with an error, after which `pixels` holds no image.
[[nodiscard]] DecodeError DecodeRvl(std::span<const uint8_t> packed, std::span<uint16_t> pixels);
[[nodiscard]] DecodeError DecodeRvl(std::span<const uint8_t> packed, std::span<uint8_t> pixels);

}  // namespace vs::wire
