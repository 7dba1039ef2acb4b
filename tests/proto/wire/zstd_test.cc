#include "proto/wire/zstd.h"

#include <gtest/gtest.h>

#include "tests/proto/wire/images.h"

namespace vs::wire {
namespace {

std::vector<uint8_t> Pack(ZstdPacker& packer, const std::vector<uint8_t>& bytes) {
  std::vector<uint8_t> packed(ZstdPacker::Bound(bytes.size()));
  packed.resize(packer.Pack(bytes, packed));
  return packed;
}

TEST(Zstd, BringsBackFrameAfterFrame) {
  ZstdPacker packer;
  ZstdUnpacker unpacker;
  for (uint32_t seed = 0; seed < 5; ++seed) {
    const std::vector<uint8_t> rvl = Packed(DisparityLikeImage(120, 40 + seed, seed));
    const std::vector<uint8_t> packed = Pack(packer, rvl);
    EXPECT_LT(packed.size(), rvl.size());
    std::vector<uint8_t> unpacked;
    ASSERT_EQ(DecodeError::kNone, unpacker.Unpack(packed, rvl.size(), &unpacked));
    EXPECT_EQ(rvl, unpacked);
  }
}

TEST(Zstd, RefusesToUnpackMoreThanAllowed) {
  ZstdPacker packer;
  ZstdUnpacker unpacker;
  const std::vector<uint8_t> packed = Pack(packer, std::vector<uint8_t>(100 << 20));
  EXPECT_LT(packed.size(), 20000U);
  std::vector<uint8_t> unpacked;
  EXPECT_EQ(DecodeError::kTooLarge, unpacker.Unpack(packed, (100 << 20) - 1, &unpacked));
  EXPECT_EQ(0U, unpacked.capacity());
}

TEST(Zstd, WritesNothingWhenTheRoomIsTooSmall) {
  ZstdPacker packer;
  const std::vector<uint8_t> rvl = Packed(DisparityLikeImage(120, 40, 1));
  std::vector<uint8_t> packed(16);
  EXPECT_EQ(0U, packer.Pack(rvl, packed));
}

TEST(Zstd, RefusesTruncatedFlippedAndDoubledFrames) {
  ZstdPacker packer;
  ZstdUnpacker unpacker;
  const std::vector<uint8_t> rvl = Packed(DisparityLikeImage(60, 20, 1));
  const std::vector<uint8_t> packed = Pack(packer, rvl);
  std::vector<uint8_t> unpacked;
  for (size_t size = 0; size < packed.size(); ++size) {
    const std::vector<uint8_t> part(packed.begin(), packed.begin() + static_cast<long>(size));
    EXPECT_EQ(DecodeError::kBadZstdFrame, unpacker.Unpack(part, 1 << 20, &unpacked)) << size;
  }
  for (size_t bit = 0; bit < packed.size() * 8; ++bit) {
    std::vector<uint8_t> flipped = packed;
    flipped[bit / 8] ^= static_cast<uint8_t>(1 << bit % 8);
    if (unpacker.Unpack(flipped, 1 << 20, &unpacked) == DecodeError::kNone) {
      std::vector<uint16_t> pixels(60UL * 20);
      (void)DecodeRvl(unpacked, pixels);
    }
  }
  std::vector<uint8_t> doubled = packed;
  doubled.insert(doubled.end(), packed.begin(), packed.end());
  EXPECT_EQ(DecodeError::kBadZstdFrame, unpacker.Unpack(doubled, 1 << 20, &unpacked));
}

TEST(Zstd, UnpacksTheNextFrameAfterAnError) {
  ZstdPacker packer;
  ZstdUnpacker unpacker;
  const std::vector<uint8_t> rvl = Packed(DisparityLikeImage(60, 20, 1));
  std::vector<uint8_t> packed = Pack(packer, rvl);
  std::vector<uint8_t> unpacked;
  EXPECT_EQ(DecodeError::kBadZstdFrame,
            unpacker.Unpack(std::span(packed).first(packed.size() / 2), 1 << 20, &unpacked));
  EXPECT_EQ(DecodeError::kNone, unpacker.Unpack(packed, 1 << 20, &unpacked));
  EXPECT_EQ(rvl, unpacked);
}

}  // namespace
}  // namespace vs::wire
