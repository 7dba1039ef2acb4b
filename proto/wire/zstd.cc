#include "proto/wire/zstd.h"

#include <zstd.h>

#include <new>

namespace vs::wire {
namespace {

constexpr int kLevel = 1;  // higher levels cost several times as much and save a few per cent

}  // namespace

ZstdPacker::ZstdPacker() : context_(ZSTD_createCCtx(), ZSTD_freeCCtx) {
  if (context_ == nullptr) throw std::bad_alloc();
}

size_t ZstdPacker::Bound(size_t bytes) { return ZSTD_compressBound(bytes); }

size_t ZstdPacker::Pack(std::span<const uint8_t> bytes, std::span<uint8_t> packed) {
  const size_t size = ZSTD_compressCCtx(context_.get(), packed.data(), packed.size(), bytes.data(),
                                        bytes.size(), kLevel);
  return ZSTD_isError(size) != 0 ? 0 : size;
}

ZstdUnpacker::ZstdUnpacker() : context_(ZSTD_createDCtx(), ZSTD_freeDCtx) {
  if (context_ == nullptr) throw std::bad_alloc();
}

DecodeError ZstdUnpacker::Unpack(std::span<const uint8_t> packed, size_t max_bytes,
                                 std::vector<uint8_t>* bytes) {
  if (ZSTD_findFrameCompressedSize(packed.data(), packed.size()) != packed.size()) {
    return DecodeError::kBadZstdFrame;
  }
  const unsigned long long size = ZSTD_getFrameContentSize(packed.data(), packed.size());
  if (size == ZSTD_CONTENTSIZE_UNKNOWN || size == ZSTD_CONTENTSIZE_ERROR) {
    return DecodeError::kBadZstdFrame;
  }
  if (size > max_bytes) return DecodeError::kTooLarge;
  bytes->resize(size);
  const size_t unpacked = ZSTD_decompressDCtx(context_.get(), bytes->data(), bytes->size(),
                                              packed.data(), packed.size());
  return unpacked == size ? DecodeError::kNone : DecodeError::kBadZstdFrame;
}

}  // namespace vs::wire
