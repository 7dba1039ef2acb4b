#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "proto/wire/decode_error.h"

struct ZSTD_CCtx_s;
struct ZSTD_DCtx_s;

namespace vs::wire {

// Makes RVL bytes smaller still, for thin lines: one zstd frame of level 1 that states its size.
// Keeps its working memory from frame to frame. Not for two threads at once.
class ZstdPacker {
 public:
  ZstdPacker();

  // Room that Pack needs, in bytes: a little more than the input.
  static size_t Bound(size_t bytes);

  // Returns the packed size in bytes. `packed` must have room for Bound(bytes.size()); with less
  // 0 is returned.
  size_t Pack(std::span<const uint8_t> bytes, std::span<uint8_t> packed);

 private:
  std::unique_ptr<ZSTD_CCtx_s, size_t (*)(ZSTD_CCtx_s*)> context_;
};

// The way back. Keeps its working memory from frame to frame. Not for two threads at once.
class ZstdUnpacker {
 public:
  ZstdUnpacker();

  // Unpacks into `bytes`, which gets the size that it needs. `packed` may be anything; what would
  // unpack to more than max_bytes is refused before memory is taken for it.
  [[nodiscard]] DecodeError Unpack(std::span<const uint8_t> packed, size_t max_bytes,
                                   std::vector<uint8_t>* bytes);

 private:
  std::unique_ptr<ZSTD_DCtx_s, size_t (*)(ZSTD_DCtx_s*)> context_;
};

}  // namespace vs::wire
